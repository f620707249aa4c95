#include "picture/picture.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "common/text.h"
#include "percale/error.h"
#include "program/commands.h"
#include "program/exit_codes.h"
#include "report/image.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

struct PictureOptions {
    std::vector<std::string> paths;  // DIR..., or MESH...
    std::string out, movie;
    std::string frame, time, frames, sheet;  // "" = not given
    std::string view, target, size = "1200x900", background = "studio", field;
    std::optional<double> azimuth, elevation, zoom;
    std::vector<double> range;
    std::vector<std::string> hidden, colours;
    bool no_ground = false, wire = false, quiet = false;
    int threads = 0;
};

/// The whole numbers of a text, which `separator` stands between. Throws SceneError naming the option.
std::vector<int> whole_numbers(const std::string& option, const std::string& text, char separator) {
    std::vector<int> numbers;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(separator, start), text.size());
        int number = 0;
        const auto [rest, error] = std::from_chars(text.data() + start, text.data() + end, number);
        if (error != std::errc() || rest != text.data() + end || start == end)
            throw SceneError(option + " " + text + ": '" + text.substr(start, end - start) + "' is not a whole number");
        numbers.push_back(number);
        start = end + 1;
    }
    return numbers;
}

/// "1200x900".
std::pair<int, int> two_sides(const std::string& option, const std::string& text) {
    const std::vector<int> sides = whole_numbers(option, text, 'x');
    if (sides.size() != 2 || sides[0] < 1 || sides[1] < 1)
        throw SceneError(option + " " + text + ": must be two whole numbers above 0 with an x between, as 1200x900");
    return {sides[0], sides[1]};
}

double number_of_text(const std::string& option, const std::string& text) {
    double number = 0.0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || rest != text.data() + text.size() || !std::isfinite(number))
        throw SceneError(option + " " + text + ": is not a finite number");
    return number;
}

Vec3 point_of_text(const std::string& option, const std::string& text) {
    const auto first = text.find(','), second = first == std::string::npos ? first : text.find(',', first + 1);
    if (second == std::string::npos) throw SceneError(option + " " + text + ": must be three numbers in m, as 0,1.2,0");
    return {number_of_text(option, text.substr(0, first)), number_of_text(option, text.substr(first + 1, second - first - 1)),
            number_of_text(option, text.substr(second + 1))};
}

CameraAim aim_of(const PictureOptions& options) {
    CameraAim aim = options.view.empty() ? CameraAim{} : aim_of_view(options.view);
    aim.azimuth = options.azimuth.value_or(aim.azimuth);
    aim.elevation = options.elevation.value_or(aim.elevation);
    aim.zoom = options.zoom.value_or(aim.zoom);
    if (!options.target.empty()) aim.target = point_of_text("--target", options.target);
    return aim;
}

PictureStyle style_of(const PictureOptions& options) {
    PictureStyle style;
    std::tie(style.width, style.height) = two_sides("--size", options.size);
    check_picture_size(style.width, style.height);
    style.aim = aim_of(options);
    style.background = background_of(options.background);
    style.ground = !options.no_ground;
    style.wire = options.wire;
    if (!options.field.empty()) style.field = &picture_field(options.field);
    if (!options.range.empty() && style.field == nullptr) throw SceneError("--range: is of a field; name it by --field");
    if (!options.range.empty()) style.range = {options.range[0], options.range[1]};
    return style;
}

ShownChoice choice_of(const PictureOptions& options, const PictureStyle& style) {
    ShownChoice choice{style.field, options.hidden, {}};
    for (const std::string& text : options.colours) {
        const std::size_t equals = text.rfind('=');
        if (equals == std::string::npos) throw SceneError("--colour " + text + ": must be NAME=RRGGBB");
        choice.colours[text.substr(0, equals)] = colour_of_hex(text.substr(equals + 1));
    }
    return choice;
}

/// A source for each folder, or one for all meshes.
std::vector<FrameSource> sources_of(const std::vector<std::string>& paths, const ShownChoice& choice) {
    const auto is_folder = [](const std::string& path) { return std::filesystem::is_directory(path); };
    std::vector<FrameSource> sources;
    if (std::ranges::none_of(paths, is_folder)) {
        sources.push_back(FrameSource::of_meshes(paths, choice));
        return sources;
    }
    for (const std::string& path : paths) {
        if (!is_folder(path)) throw SceneError(path + ": is not the folder of a run; name either folders of runs, or meshes");
        sources.push_back(FrameSource::of_run(path, choice));
    }
    return sources;
}

int checked_frame(const std::string& option, int frame, const FrameSource& source) {
    if (frame < 0 || frame >= source.count())
        throw SceneError(option + " " + std::to_string(frame) + ": '" + source.name() + "' has " +
                         counted(source.count(), "frame") + ", 0 ... " + std::to_string(source.count() - 1));
    return frame;
}

/// The frame that --frame or --time names, else the last.
int single_frame(const PictureOptions& options, const FrameSource& source) {
    if (!options.frame.empty()) {
        const std::vector<int> frames = whole_numbers("--frame", options.frame, ',');
        if (frames.size() > 1) throw SceneError("--frame " + options.frame + ": names more than one; see --frames");
        return checked_frame("--frame", frames[0], source);
    }
    if (options.time.empty()) return source.count() - 1;
    const double time = number_of_text("--time", options.time), last = source.time(source.count() - 1);
    // A time as people write it may be above a sum of steps by rounding.
    if (time < 0.0 || time > last * (1.0 + 1e-9))
        throw SceneError("--time " + options.time + ": '" + source.name() + "' has frames from 0 to " + number_text(last) + " s");
    return source.nearest_frame(time);
}

/// The frames of --frames; without, `count` frames spread evenly from the first to the last, all where count is 0.
std::vector<int> several_frames(const PictureOptions& options, const FrameSource& source, int count) {
    std::vector<int> frames;
    if (!options.frames.empty()) {
        for (const int frame : whole_numbers("--frames", options.frames, ','))
            frames.push_back(checked_frame("--frames", frame, source));
        return frames;
    }
    if (count > source.count())
        throw SceneError("--sheet " + options.sheet + ": '" + source.name() + "' has " + counted(source.count(), "frame") +
                         " only");
    const int last = source.count() - 1, all = count == 0 ? source.count() : count;
    for (int k = 0; k < all; ++k)
        frames.push_back(all == 1 ? last : static_cast<int>(std::lround(static_cast<double>(k) * last / (all - 1))));
    return frames;
}

std::string time_label(double time) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f s", time);
    return text;
}

/// What the picture shows: one frame; several of a run with their times; the same of several runs with their names.
std::vector<PictureCell> cells_of(const PictureOptions& options, std::vector<FrameSource>& sources, CellGrid& grid) {
    std::vector<PictureCell> cells;
    const bool asks_sheet = !options.frames.empty() || !options.sheet.empty();
    if (!options.sheet.empty()) std::tie(grid.columns, grid.rows) = two_sides("--sheet", options.sheet);
    if (sources.size() > 1) {
        if (!options.frames.empty()) throw SceneError("--frames: is for one run; of several one frame each is shown");
        for (FrameSource& source : sources) cells.push_back({&source, single_frame(options, source), source.name()});
    } else if (asks_sheet) {
        const int count = options.frames.empty() ? grid.columns * grid.rows : 0;
        for (const int frame : several_frames(options, sources[0], count))
            cells.push_back({&sources[0], frame, time_label(sources[0].time(frame))});
    } else {
        cells.push_back({&sources[0], single_frame(options, sources[0])});
    }
    return cells;
}

void check_together(const PictureOptions& options) {
    const auto exclude = [](const char* one, bool has_one, const char* other, bool has_other) {
        if (has_one && has_other) throw SceneError(std::string(one) + " and " + other + " exclude each other");
    };
    exclude("--frame", !options.frame.empty(), "--time", !options.time.empty());
    for (const auto& [name, text] : {std::pair("--frames", &options.frames), std::pair("--movie", &options.movie)}) {
        exclude(name, !text->empty(), "--frame", !options.frame.empty());
        exclude(name, !text->empty(), "--time", !options.time.empty());
    }
    exclude("--sheet", !options.sheet.empty(), "--movie", !options.movie.empty());
    exclude("-o", !options.out.empty(), "--movie", !options.movie.empty());
    if (options.out.empty() && options.movie.empty()) throw SceneError("-o OUT.png or --movie DIR must be given");
    if (!options.out.empty() && std::filesystem::path(options.out).extension() != ".png")
        throw SceneError("-o " + options.out + ": its name must end in .png, which is what is written");
}

PictureNews news_of(const PictureOptions& options, const PictureStyle& style) {
    if (options.quiet) return {};
    return {.range = [&style](const FieldRange& range) {
        std::printf("%s: %s ... %s %s%s%s\n", style.field->word.c_str(), short_number(range.low).c_str(),
                    short_number(range.high).c_str(), style.field->unit.c_str(), range.some_below ? ", some below" : "",
                    range.some_above ? ", some above" : "");
    }};
}

int make_pictures(const PictureOptions& options) {
    if (const std::string missing = pictures_missing(); !missing.empty()) throw SceneError(missing);
    check_together(options);
    const PictureStyle style = style_of(options);
    std::vector<FrameSource> sources = sources_of(options.paths, choice_of(options, style));
    for (const Finding& warning : sources[0].warnings())
        if (!options.quiet) print_finding(warning);
    const std::shared_ptr<Workers> workers = make_workers(options.threads);
    const PictureNews news = news_of(options, style);
    if (!options.movie.empty()) {
        if (sources.size() > 1) throw SceneError("--movie: is of one run");
        const std::vector<int> frames = several_frames(options, sources[0], 0);
        write_movie(options.movie, sources[0], frames, style, workers.get(), news);
        if (!options.quiet)
            std::printf("%s: %s\n", options.movie.c_str(), counted(static_cast<long>(frames.size()), "picture").c_str());
        return all_well;
    }
    CellGrid grid;
    const std::vector<PictureCell> cells = cells_of(options, sources, grid);
    if (options.sheet.empty()) grid = grid_for(static_cast<int>(cells.size()), style.width, style.height);
    write_png(options.out, draw_picture(cells, grid, style, workers.get(), news));
    if (!options.quiet) std::printf("%s: %dx%d pixels\n", options.out.c_str(), style.width, style.height);
    return all_well;
}

void add_what_options(CLI::App& command, PictureOptions& options) {
    command.add_option("PATH", options.paths, "The folder of a run, several for a sheet of their last frames, or meshes")
        ->required();
    command.add_option("-o", options.out, "Picture to write")->type_name("OUT.png");
    command.add_option("--frame", options.frame, "Frame, counted from 0 (default: the last)")->type_name("N");
    command.add_option("--time", options.time, "The frame nearest to a time, s")->type_name("S");
    command.add_option("--frames", options.frames, "Contact sheet of these frames, or those of a movie")->type_name("N,N,...");
    command.add_option("--sheet", options.sheet, "Contact sheet of so many columns and rows; without --frames evenly spread")
        ->type_name("CxR");
    command.add_option("--movie", options.movie, "Folder for pictures frame_00000.png ... of all frames")->type_name("DIR");
    command.add_option("--field", options.field, "Colour cloth by " + joined(picture_field_words()))->type_name("NAME");
    command.add_option("--range", options.range, "Ends of the bar of colours, in its unit")->type_name("LOW HIGH")->expected(2);
    command.add_option("--hide", options.hidden, "Leave out a cloth or body")->type_name("NAME")->expected(1);
    command.add_option("--colour", options.colours, "Colour of a cloth or body")->type_name("NAME=RRGGBB")->expected(1);
}

void add_look_options(CLI::App& command, PictureOptions& options) {
    command.add_option("--view", options.view, "front, side, back, top or three_quarter (default)")->type_name("VIEW");
    command.add_option("--azimuth", options.azimuth, "Around the y axis, degrees; 0 looks at the side that faces +z")
        ->type_name("DEG");
    command.add_option("--elevation", options.elevation, "Above the horizon, degrees")->type_name("DEG");
    command.add_option("--zoom", options.zoom, "How much larger than what fits (default 1)")->type_name("X");
    command.add_option("--target", options.target, "What the middle shows, m (default: the middle of all)")->type_name("X,Y,Z");
    command.add_option("--size", options.size, "Pixels (default 1200x900)")->type_name("WxH");
    command.add_option("--background", options.background, "studio (default), white or transparent")->type_name("WORD");
    command.add_flag("--no-ground", options.no_ground, "No shadows on a ground");
    command.add_flag("--wire", options.wire, "Draw the edges of triangles");
    command.add_option("--threads", options.threads, "Threads; 0, the default: as many as the machine runs")->type_name("N");
    command.add_flag("--quiet", options.quiet, "Print nothing but errors");
}

}  // namespace

void add_picture_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<PictureOptions>();
    CLI::App* command = program.add_subcommand("picture", "Draw frames of a run, or meshes, without a display");
    command->alias("render");
    command->footer(
        "Examples: percale picture out -o out.png --view front\n          percale picture out -o out.png --sheet 3x2\n"
        "          percale picture body.obj shirt.obj -o shirt.png --field distance");
    add_what_options(*command, *options);
    add_look_options(*command, *options);
    command->callback([options, &action] { action = [options] { return make_pictures(*options); }; });
}

}  // namespace percale::program
