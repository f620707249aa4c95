#include "percale/options.h"

#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>

#include "percale/error.h"
#include "percale/saved_state.h"

namespace percale {
namespace {

constexpr std::string_view scheme_words[] = {"forward_euler",     "symplectic_euler", "midpoint", "rk4",     "backward_euler",
                                             "implicit_midpoint", "trapezoid",        "bdf2",     "tr_bdf2", "auto"};
constexpr std::string_view solver_words[] = {"auto", "cg", "multigrid", "direct"};
constexpr std::string_view response_words[] = {"penalty", "projection"};
constexpr std::string_view damping_words[] = {"length_rate", "velocity"};
constexpr std::string_view start_words[] = {"repair", "refuse"};
constexpr std::string_view measure_words[] = {"auto", "all", "none", "ledger"};
constexpr std::string_view membrane_words[] = {"triangle_springs", "van_gelder"};

constexpr Option<Fabric> fabric_list[] = {
    {.key = "area_density",
     .unit = "kg/m^2",
     .sentence = "Mass of one square metre.",
     .lowest = 1e-4,
     .highest = 1e3,
     .number = [](Fabric& f) { return &f.area_density; }},
    {.key = "thickness",
     .unit = "m",
     .sentence = "Gap kept from obstacles, measured from the middle surface.",
     .lowest = 1e-6,
     .highest = 1.0,
     .number = [](Fabric& f) { return &f.thickness; }},
    {.key = "self_contact",
     .unit = "",
     .sentence = "Whether it meets itself and other cloth of which this is true; two sheets keep the mean of their thicknesses.",
     .flag = [](Fabric& f) { return &f.self_contact; }},
    {.key = "friction",
     .unit = "",
     .sentence = "Coulomb coefficient between cloths (self_contact); of two fabrics the mean.",
     .lowest = 0.0,
     .highest = 10.0,
     .number = [](Fabric& f) { return &f.friction; }},
    {.key = "springs.structural",
     .unit = "N/m",
     .sentence = "Constant of each spring along rows and columns of a grid, or along each edge of a free mesh.",
     .lowest = 0.0,
     .highest = 1e9,
     .required = true,
     .number = [](Fabric& f) { return &f.springs.structural; }},
    {.key = "springs.shear",
     .unit = "N/m",
     .sentence = "Constant of each spring on both diagonals of every grid cell; an error on a free mesh unless 0.",
     .lowest = 0.0,
     .highest = 1e9,
     .number = [](Fabric& f) { return &f.springs.shear; }},
    {.key = "springs.bend",
     .unit = "N/m",
     .sentence = "Constant of each spring two apart along rows and columns, or across each inner edge of a free mesh.",
     .lowest = 0.0,
     .highest = 1e9,
     .number = [](Fabric& f) { return &f.springs.bend; }},
    {.key = "spring_damping",
     .unit = "N s/m",
     .sentence = "Damping of each spring, along the spring only.",
     .lowest = 0.0,
     .highest = 1e6,
     .number = [](Fabric& f) { return &f.spring_damping; }},
    {.key = "damping_time",
     .unit = "s",
     .sentence = "Damping of each spring over its stiffness; instead of spring_damping.",
     .lowest = 0.0,
     .highest = 10.0,
     .optional_number = [](Fabric& f) { return &f.damping_time; }},
    {.key = "stretch_stiffness",
     .unit = "N/m",
     .sentence =
         "Force per width and strain of a strip pulled along warp and along weft (Young's modulus times thickness); instead "
         "of springs. Warp and weft are the x and z axes of a grid; on a mesh cloth.warp says where.",
     .lowest = 1e-2,
     .highest = 1e9,
     .optional_pair = [](Fabric& f) { return &f.stretch_stiffness; }},
    {.key = "shear_stiffness",
     .unit = "N/m",
     .sentence = "Shear force per width and angle; without it that of isotropic cloth, from stretch_stiffness and poisson_ratio.",
     .lowest = 1e-2,
     .highest = 1e9,
     .optional_number = [](Fabric& f) { return &f.shear_stiffness; }},
    {.key = "poisson_ratio",
     .unit = "",
     .sentence = "How much cloth of a given stretch_stiffness narrows when pulled; the geometric mean of warp and weft.",
     .lowest = -0.9,
     .highest = 0.9,
     .number = [](Fabric& f) { return &f.poisson_ratio; }},
    {.key = "membrane",
     .unit = "",
     .sentence =
         "What carries a given stretch_stiffness: triangle_springs = springs on the squared lengths of a triangle's edges, "
         "exact for every modulus; van_gelder = plain springs, isotropic only, 1.2 times too stiff on grids.",
     .choices = membrane_words,
     .get_choice = [](const Fabric& f) { return static_cast<int>(f.membrane); },
     .set_choice = [](Fabric& f, int i) { f.membrane = static_cast<Membrane>(i); }},
    {.key = "strain_limit",
     .unit = "",
     .sentence =
         "Strain beyond which every edge holds back, along rows and columns of a grid or every edge of a mesh; implicit schemes "
         "only. Passed for some steps where load comes suddenly, and for good where an edge is pulled with more than twice its "
         "stiffness.",
     .lowest = 1e-3,
     .highest = 1.0,
     .optional_number = [](Fabric& f) { return &f.strain_limit; }},
    {.key = "bend_stiffness",
     .unit = "N m",
     .sentence = "Moment per width and curvature; instead of springs.bend.",
     .lowest = 0.0,
     .highest = 1e3,
     .optional_number = [](Fabric& f) { return &f.bend_stiffness; }},
    {.key = "drag_normal",
     .unit = "",
     .sentence = "Drag coefficient against air that meets the surface (wind); a flat plate has 1.1 to 2.",
     .lowest = 0.0,
     .highest = 10.0,
     .number = [](Fabric& f) { return &f.drag_normal; }},
    {.key = "drag_tangential",
     .unit = "",
     .sentence = "Drag coefficient against air that passes along the surface (wind).",
     .lowest = 0.0,
     .highest = 10.0,
     .number = [](Fabric& f) { return &f.drag_tangential; }},
    {.key = "pressure",
     .unit = "Pa",
     .sentence = "Pressure inside a closed cloth above that outside, whatever its volume; below 0 it is sucked in.",
     .lowest = -1e6,
     .highest = 1e6,
     .optional_number = [](Fabric& f) { return &f.pressure; }},
    {.key = "gas_volume",
     .unit = "m^3",
     .sentence =
         "Volume that the gas sealed in a closed cloth has at the pressure of the air, 101325 Pa; instead of pressure. The "
         "gas resists a change of its volume.",
     .lowest = 1e-9,
     .highest = 1e3,
     .optional_number = [](Fabric& f) { return &f.gas_volume; }},
};

constexpr Option<StepSettings> step_list[] = {
    {.key = "time_step",
     .unit = "s",
     .sentence =
         "Length of a step; auto = as long as `tolerance` allows, 1/60 s at most; scheme is tr_bdf2 then unless it is set.",
     .lowest = 1e-7,
     .highest = 1.0,
     .number = [](StepSettings& s) { return &s.time_step; },
     .automatic = [](StepSettings& s) { return &s.adaptive; }},
    {.key = "tolerance",
     .unit = "m",
     .sentence = "Error of positions, in the mean over a cloth, that the steps of a second may add by their estimates; what "
                 "becomes of it "
                 "later is the cloth's (percale compare measures it). Used where time_step is auto.",
     .lowest = 1e-9,
     .highest = 1.0,
     .number = [](StepSettings& s) { return &s.tolerance; }},
    {.key = "scheme",
     .unit = "",
     .sentence =
         "Time integration: forward_euler, symplectic_euler, midpoint and rk4 are explicit and need small steps, the others "
         "are implicit; backward_euler and tr_bdf2 take obstacles and self_contact; auto = symplectic_euler where that "
         "is cheaper, else backward_euler.",
     .choices = scheme_words,
     .get_choice = [](const StepSettings& s) { return static_cast<int>(s.scheme); },
     .set_choice = [](StepSettings& s, int i) { s.scheme = static_cast<Scheme>(i); }},
    {.key = "newton_tolerance",
     .unit = "",
     .sentence =
         "Residual relative to the first of the step; auto keeps the solver's error below newton_error_ratio of the step's time "
         "error.",
     .lowest = 1e-12,
     .highest = 1.0,
     .number_or_auto = [](StepSettings& s) { return &s.newton_tolerance; }},
    {.key = "newton_error_ratio",
     .unit = "",
     .sentence = "How large the solver's error may be beside the step's time error, where newton_tolerance is auto; in steps of "
                 "automatic length at most 0.25.",
     .former = "newton_share",
     .lowest = 1e-3,
     .highest = 100.0,
     .number = [](StepSettings& s) { return &s.newton_error_ratio; }},
    {.key = "newton_iterations",
     .unit = "",
     .sentence = "Newton iterations at most; 1 is linearly implicit.",
     .lowest = 1,
     .highest = 1000,
     .integer = [](StepSettings& s) { return &s.newton_iterations; }},
    {.key = "work_limit",
     .unit = "",
     .sentence = "Newton iterations of one step at most, of all that it is divided into and solved again; beyond, the step fails "
                 "and the state stays; auto = no limit.",
     .lowest = 1,
     .highest = 50000,
     .changes_steps = false,
     .integer = [](StepSettings& s) { return &s.work_limit; },
     .zero_is_auto = true},
    {.key = "linear_solver",
     .unit = "",
     .sentence = "How the linear system of a Newton iteration is solved: cg = conjugate gradient with block Jacobi, multigrid = "
                 "with a V-cycle, "
                 "direct = sparse factorisation, auto = cg until a solve takes more than 25 iterations, then multigrid.",
     .choices = solver_words,
     .get_choice = [](const StepSettings& s) { return static_cast<int>(s.linear_solver); },
     .set_choice = [](StepSettings& s, int i) { s.linear_solver = static_cast<LinearSolver>(i); }},
    {.key = "contact_response",
     .unit = "",
     .sentence = "How contact acts inside a step: penalty = springs that grow without bound as the distance goes to 0, "
                 "projection = constraints that keep cloth at the thickness itself, with exact Coulomb friction; dearer.",
     .choices = response_words,
     .get_choice = [](const StepSettings& s) { return static_cast<int>(s.contact_response); },
     .set_choice = [](StepSettings& s, int i) { s.contact_response = static_cast<ContactResponse>(i); }},
    {.key = "threads",
     .unit = "",
     .sentence = "Threads of one simulation; auto = as many of the machine's cores as pay for this number of vertices. Results "
                 "are the same for any number.",
     .lowest = 1,
     .highest = 64,
     .changes_steps = false,
     .integer = [](StepSettings& s) { return &s.threads; },
     .zero_is_auto = true},
    {.key = "damping_form",
     .unit = "",
     .sentence = "Spring damping as the rate of the length over the step (backward Euler only) or by the relative velocity.",
     .choices = damping_words,
     .get_choice = [](const StepSettings& s) { return static_cast<int>(s.damping_form); },
     .set_choice = [](StepSettings& s, int i) { s.damping_form = static_cast<DampingForm>(i); }},
    {.key = "measure",
     .unit = "",
     .sentence =
         "What each step reports besides contacts: all = energy, strain and speed; ledger = all and what became of energy; none "
         "leaves them out; auto = what [expect] reads, and for the rest the states of output frames alone.",
     .choices = measure_words,
     .get_choice = [](const StepSettings& s) { return static_cast<int>(s.measure); },
     .set_choice = [](StepSettings& s, int i) { s.measure = static_cast<StepMeasures>(i); }},
    {.key = "start",
     .unit = "",
     .sentence =
         "Cloth that starts through, inside or touching an obstacle, or with self_contact through such cloth: repair = it is "
         "moved out first, and the report says what moved how far; refuse = it is an error.",
     .choices = start_words,
     .changes_steps = false,
     .get_choice = [](const StepSettings& s) { return static_cast<int>(s.start); },
     .set_choice = [](StepSettings& s, int i) { s.start = static_cast<StartRule>(i); }},
    {.key = "kinetic_damping",
     .unit = "",
     .sentence =
         "Whether all cloth is stopped after each step in which its potential energy has risen, so that what swings comes "
         "to rest sooner, on a path that means nothing; not while pins or obstacles move, seams close or wind blows.",
     .flag = [](StepSettings& s) { return &s.kinetic_damping; }},
    {.key = "rest_speed",
     .unit = "m/s",
     .sentence =
         "Cloth is still that for half a second has kept within half a second times this of one place; auto: within 0.002 of its "
         "thickness.",
     .lowest = 1e-9,
     .highest = 1.0,
     .number_or_auto = [](StepSettings& s) { return &s.rest_speed; }},
    {.key = "skip",
     .unit = "",
     .sentence = "Whether work that the scene does not need is left out (percale plan lists it); false runs everything.",
     .flag = [](StepSettings& s) { return &s.skip; }},
    {.key = "air_density",
     .unit = "kg/m^3",
     .sentence = "Density of the air that wind moves; without a wind event there is no air.",
     .lowest = 0.0,
     .highest = 1e4,
     .number = [](StepSettings& s) { return &s.air_density; }},
    {.key = "check_derivatives",
     .unit = "",
     .sentence =
         "Whether every force but friction and projected contact is compared with its energy and its matrix by differences after "
         "each step, which fails where they do not fit; slow.",
     .changes_steps = false,
     .flag = [](StepSettings& s) { return &s.check_derivatives; }},
};

void check_number(std::string_view owner, std::string_view key, std::string_view unit, double value, double low, double high) {
    if (std::isfinite(value) && value >= low && value <= high) return;
    std::ostringstream text;
    text << key << " = " << value << (unit.empty() ? "" : " ") << unit << " is outside the allowed range " << low << " ... "
         << high;
    throw SceneError(std::string(owner), text.str());
}

template <class Owner>
void check_fields(Owner owner, std::string_view name, std::span<const Option<Owner>> options) {
    for (const Option<Owner>& option : options) {
        const auto check = [&](double value) {
            check_number(name, option.key, option.unit, value, option.lowest, option.highest);
        };
        if (option.number) check(*option.number(owner));
        if (option.integer && !(option.zero_is_auto && *option.integer(owner) == 0)) check(*option.integer(owner));
        if (option.number_or_auto && option.number_or_auto(owner)->has_value()) check(**option.number_or_auto(owner));
        if (option.optional_number && option.optional_number(owner)->has_value()) check(**option.optional_number(owner));
        if (option.optional_pair && option.optional_pair(owner)->has_value()) {
            for (const double value : **option.optional_pair(owner)) check(value);
        }
    }
}

bool same(const SpringConstants& a, const SpringConstants& b) {
    return a.structural == b.structural && a.shear == b.shear && a.bend == b.bend;
}

/// Springs and damping that keep their defaults, or that are absent, do not contradict moduli.
void check_exclusions(const Fabric& fabric, const std::string& name) {
    const Fabric defaults;
    const bool own_springs = !same(fabric.springs, defaults.springs) && !same(fabric.springs, {.structural = 0.0});
    if (fabric.has_moduli() && own_springs) throw SceneError(name, "springs and stretch_stiffness exclude each other");
    if (fabric.bend_stiffness && !fabric.has_moduli() && fabric.springs.bend != 0.0) {
        throw SceneError(name, "springs.bend and bend_stiffness exclude each other");
    }
    const bool own_damping = fabric.spring_damping != defaults.spring_damping && fabric.spring_damping != 0.0;
    if (fabric.damping_time && own_damping) throw SceneError(name, "spring_damping and damping_time exclude each other");
    if (fabric.pressure && fabric.gas_volume) throw SceneError(name, "pressure and gas_volume exclude each other");
}

void check_moduli(const Fabric& fabric, const std::string& name) {
    if (!fabric.has_moduli()) {
        if (fabric.shear_stiffness) throw SceneError(name, "shear_stiffness needs stretch_stiffness");
        if (fabric.poisson_ratio != 0.0) throw SceneError(name, "poisson_ratio needs stretch_stiffness");
        return;
    }
    if (fabric.membrane != Membrane::van_gelder) return;
    const std::string only = "membrane = van_gelder is isotropic, ";
    const auto [warp, weft] = *fabric.stretch_stiffness;
    if (warp != weft) throw SceneError(name, only + "stretch_stiffness must be the same along warp and weft");
    if (fabric.shear_stiffness) throw SceneError(name, only + "it takes no shear_stiffness");
    if (fabric.poisson_ratio != 0.0) throw SceneError(name, only + "it takes no poisson_ratio: the mesh decides it");
}

}  // namespace

std::uint64_t options_hash(const StepSettings& settings) {
    StepSettings of = settings;  // the list of options needs writable fields
    StateWriter writer;
    const auto put = [&](auto field) {
        if (field) writer(*field(of));
    };
    for (const Option<StepSettings>& option : step_list) {
        if (!option.changes_steps) continue;
        if (option.automatic) {
            writer(*option.automatic(of));
            continue;
        }
        put(option.number);
        put(option.integer);
        put(option.flag);
        put(option.number_or_auto);
        put(option.optional_number);
        put(option.optional_pair);
        if (option.get_choice) writer(option.get_choice(of));
    }
    return checksum(writer.take());
}

std::span<const Option<Fabric>> fabric_options() { return fabric_list; }
std::span<const Option<StepSettings>> step_options() { return step_list; }

void check_options(const Fabric& fabric, std::string_view owner_name) {
    check_fields<Fabric>(fabric, owner_name, fabric_options());
    check_exclusions(fabric, std::string(owner_name));
    check_moduli(fabric, std::string(owner_name));
}

void check_options(const StepSettings& settings, std::string_view owner_name) {
    check_fields<StepSettings>(settings, owner_name, step_options());
    for (int axis = 0; axis < 3; ++axis) check_number(owner_name, "gravity", "m/s^2", settings.gravity[axis], -1e4, 1e4);
    if (!settings.wind) return;
    for (int axis = 0; axis < 3; ++axis) check_number(owner_name, "wind", "m/s", (*settings.wind)[axis], -1e3, 1e3);
}

}  // namespace percale
