#include "percale/detectors.h"

int main() { return percale::make_fcl_detector() ? 0 : 1; }
