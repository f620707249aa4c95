#pragma once

// Everything a program needs to simulate cloth. Detectors for obstacles: percale/detectors.h.
#include "percale/contact.h"
#include "percale/contact_load.h"
#include "percale/error.h"
#include "percale/fabric.h"
#include "percale/fabric_presets.h"
#include "percale/mesh.h"
#include "percale/options.h"
#include "percale/plan.h"
#include "percale/report.h"
#include "percale/rest_shape.h"
#include "percale/settings.h"
#include "percale/simulation.h"
#include "percale/strain.h"
#include "percale/workers.h"
