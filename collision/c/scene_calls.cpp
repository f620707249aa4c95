#include <memory>
#include <optional>
#include <utility>

#include "c/handles.h"
#include "c/host.h"
#include "c/rest.h"
#include "c/structs.h"

// Functions of percale.h for the contents of a simulation.

using namespace percale::c_interface;

namespace {

percale::StepSettings settings_of(const percale_setup& setup) {
    percale::StepSettings settings = setup.settings == nullptr ? percale::StepSettings{} : setup.settings->value;
    settings.gravity = vector_of(setup.gravity, "gravity");
    if (setup.has_wind != 0) settings.wind = vector_of(setup.wind, "wind");
    return settings;
}

std::vector<percale::Stitch> stitches_of(std::span<const percale_stitch> given) {
    std::vector<percale::Stitch> stitches;
    stitches.reserve(given.size());
    for (const percale_stitch& stitch : given) stitches.push_back({stitch.vertex, stitch.from, stitch.to, stitch.share});
    return stitches;
}

percale::SeamSettings seam_settings_of(const percale_seam_settings& given) {
    return {.after = given.after,
            .over = given.over,
            .stiffness = given.stiffness,
            .contact_while_closing = given.contact_while_closing != 0,
            .weld = given.weld != 0,
            .name = &demanded(given.name, "name")};
}

percale::ObstacleSettings obstacle_settings_of(const percale_obstacle_settings& given) {
    return {.friction = given.friction,
            .restitution = given.restitution,
            .name = &demanded(given.name, "name"),
            .deforming = given.deforming != 0,
            .yields = given.yields != 0};
}

}  // namespace

percale_status percale_create_simulation(const percale_setup* setup, percale_simulation** simulation) {
    return call(__func__, [&] {
        percale_simulation*& place = demanded(simulation, "the place for the simulation");
        const percale_setup& from = known(setup, "setup");
        std::shared_ptr<HostWorkers> workers;
        if (from.workers != nullptr) workers = std::make_shared<HostWorkers>(known(from.workers, "workers"));
        percale::Simulation made(settings_of(from), make_detector(&demanded(from.detector, "detector")), std::move(workers));
        place = std::make_unique<percale_simulation>(std::move(made)).release();
    });
}

void percale_destroy_simulation(percale_simulation* simulation) { delete simulation; }

percale_status percale_add_cloth(percale_simulation* simulation, const percale_mesh* mesh, const percale_fabric* fabric,
                                 const percale_cloth_settings* settings, int* cloth) {
    return call_on(__func__, simulation, [&](percale_simulation& to) {
        int& number = demanded(cloth, "the place for the number");
        const percale::TriangleMesh& shape = demanded(mesh, "mesh").value;
        const auto with = known_or_default(settings, "settings");
        const percale::RestShape rest = rest_shape(shape, with);
        number = to.simulation.add_cloth(shape, demanded(fabric, "fabric").value, pose_of(with.pose), with.name, rest).index;
    });
}

percale_status percale_add_obstacle(percale_simulation* simulation, const percale_mesh* mesh,
                                    const percale_obstacle_settings* settings, int* obstacle) {
    return call_on(__func__, simulation, [&](percale_simulation& to) {
        int& number = demanded(obstacle, "the place for the number");
        const auto with = known_or_default(settings, "settings");
        number = to.simulation.add_obstacle(demanded(mesh, "mesh").value, pose_of(with.pose), obstacle_settings_of(with)).index;
    });
}

percale_status percale_add_seam(percale_simulation* simulation, const int cloths[2], const percale_stitch* stitches, size_t count,
                                const percale_seam_settings* settings, int* seam) {
    return call_on(__func__, simulation, [&](percale_simulation& to) {
        int& number = demanded(seam, "the place for the number");
        const int* sides = &demanded(cloths, "cloths");
        const auto with = known_or_default(settings, "settings");
        const auto sewn = stitches_of(items_of(stitches, count, "stitches"));
        number = to.simulation.add_seam({sides[0]}, {sides[1]}, sewn, seam_settings_of(with)).index;
    });
}

percale_status percale_set_pair(percale_simulation* simulation, int first, int second, int contact, const double* thickness) {
    return call_on(__func__, simulation, [&](percale_simulation& of) {
        percale::ClothPair pair{.contact = contact != 0};
        if (thickness != nullptr) pair.thickness = *thickness;
        of.simulation.set_pair({first}, {second}, pair);
    });
}

percale_status percale_set_layer(percale_simulation* simulation, int cloth, int layer) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { of.simulation.set_layer({cloth}, layer); });
}

percale_status percale_remove_cloth(percale_simulation* simulation, int cloth) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { of.simulation.remove_cloth({cloth}); });
}

percale_status percale_remove_obstacle(percale_simulation* simulation, int obstacle) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { of.simulation.remove_obstacle({obstacle}); });
}

percale_status percale_set_fabric(percale_simulation* simulation, int cloth, const percale_fabric* fabric) {
    return call_on(__func__, simulation,
                   [&](percale_simulation& of) { of.simulation.set_fabric({cloth}, demanded(fabric, "fabric").value); });
}

percale_status percale_set_friction(percale_simulation* simulation, int obstacle, double friction) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { of.simulation.set_friction({obstacle}, friction); });
}

percale_status percale_set_restitution(percale_simulation* simulation, int obstacle, double restitution) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { of.simulation.set_restitution({obstacle}, restitution); });
}
