#include "tests/support/bench_meshes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <utility>

#include "tests/support/random.h"

namespace percale::test {
namespace {

using Row = std::vector<int>;

const double row_ratio = std::sqrt(3.0) / 2.0;  // distance of rows over that of points, of equilateral triangles
constexpr double sleeve_end = 0.55;             // m, of the shirt, from its middle

/// Numbers from `low` to `high` about `spacing` apart: the ends exact, those between moved at random by a fifth of the spacing.
std::vector<double> jittered(Random& random, double low, double high, double spacing) {
    const int parts = std::max(2, static_cast<int>(std::lround((high - low) / spacing)));
    std::vector<double> numbers{low};
    for (int i = 1; i < parts; ++i) numbers.push_back(low + (high - low) * (i + random.number(-0.2, 0.2)) / parts);
    numbers.push_back(high);
    return numbers;
}

/// Points of one row; a few more or fewer of them than the spacing gives, so that rows do not match.
std::vector<double> row_points(Random& random, double low, double high, double spacing) {
    return jittered(random, low, high, spacing * random.number(0.93, 1.07));
}

/// Triangles between two rows in the same direction, `left` on the left hand of that direction: at each step the shorter of the
/// two diagonals.
void zip(const Row& left, const Row& right, TriangleMesh& mesh) {
    std::size_t i = 0, j = 0;
    const auto distance = [&mesh](int a, int b) { return (mesh.vertices[a] - mesh.vertices[b]).squaredNorm(); };
    while (i + 1 < left.size() || j + 1 < right.size()) {
        const bool left_ends = i + 1 == left.size(), right_ends = j + 1 == right.size();
        if (!left_ends && (right_ends || distance(left[i + 1], right[j]) < distance(left[i], right[j + 1]))) {
            mesh.triangles.push_back({left[i], right[j], left[i + 1]});
            ++i;
        } else {
            mesh.triangles.push_back({left[i], right[j], right[j + 1]});
            ++j;
        }
    }
}

Row append_constraint(const std::vector<Vec3>& points, TriangleMesh& mesh) {
    Row row;
    for (const Vec3& x : points) {
        row.push_back(static_cast<int>(mesh.vertices.size()));
        mesh.vertices.push_back(x);
    }
    return row;
}

TriangleMesh sheet_of_spacing(double size, double spacing) {
    Random random(1);
    TriangleMesh mesh;
    const double half = 0.5 * size;
    const std::vector<double> heights = jittered(random, -half, half, row_ratio * spacing);
    Row before;
    for (const double z : heights) {
        const bool border = z == heights.front() || z == heights.back();
        std::vector<Vec3> points;
        for (const double x : row_points(random, -half, half, spacing)) {
            points.emplace_back(x, 0.0, z + (border || std::abs(x) == half ? 0.0 : 0.12 * spacing * random.number(-1.0, 1.0)));
        }
        const Row row = append_constraint(points, mesh);
        if (!before.empty()) zip(before, row, mesh);
        before = row;
    }
    return mesh;
}

/// Rows around the axis at even distances on the cone; each starts at its own angle.
TriangleMesh skirt_of_spacing(double spacing) {
    const double waist = 0.15, hem = 0.4, length = 0.6, turn = 2.0 * std::numbers::pi;
    Random random(2);
    TriangleMesh mesh;
    Row before;
    for (const double part : jittered(random, 0.0, 1.0, row_ratio * spacing / std::hypot(length, hem - waist))) {
        const double radius = waist + part * (hem - waist), begin = random.number(0.0, spacing / radius);
        std::vector<Vec3> points;
        for (const double angle : row_points(random, begin, begin + turn, spacing / radius)) {
            points.emplace_back(radius * std::sin(angle), -length * part, radius * std::cos(angle));
        }
        points.pop_back();  // equal to the first
        Row row = append_constraint(points, mesh);
        row.push_back(row.front());
        if (!before.empty()) zip(before, row, mesh);
        before = row;
    }
    return mesh;
}

/// One side of the shirt in the plane; rows run from -x to +x.
struct ShirtPanel {
    TriangleMesh mesh;
    std::vector<bool> on_seam;  // one a vertex
};

void append_seam(ShirtPanel& panel, const std::function<bool(const Vec3&)>& is_seam) {
    for (std::size_t i = panel.on_seam.size(); i < panel.mesh.vertices.size(); ++i) {
        panel.on_seam.push_back(is_seam(panel.mesh.vertices[i]));
    }
}

/// The body below the arms, up to but without the row under the arms.
Row append_body(Random& random, double half_width, const std::vector<double>& heights, ShirtPanel& panel) {
    const double spacing = (heights[1] - heights[0]) / row_ratio;
    Row before;
    for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
        std::vector<Vec3> points;
        for (const double x : row_points(random, -half_width, half_width, spacing)) points.emplace_back(x, heights[k], 0.0);
        const Row row = append_constraint(points, panel.mesh);
        if (!before.empty()) zip(row, before, panel.mesh);
        before = row;
    }
    append_seam(panel, [&](const Vec3& x) { return std::abs(x.x()) == half_width; });
    return before;
}

/// A row from sleeve to sleeve in three parts that meet at `inner` exactly.
Row append_wide_row(Random& random, double inner, double y, double spacing, ShirtPanel& panel) {
    std::vector<Vec3> points;
    const double ends[4] = {-sleeve_end, -inner, inner, sleeve_end};
    for (int part = 0; part < 3; ++part) {
        for (const double x : row_points(random, ends[part], ends[part + 1], spacing)) {
            if (part == 0 || x != ends[part]) points.emplace_back(x, y, 0.0);
        }
    }
    return append_constraint(points, panel.mesh);
}

ShirtPanel shirt_panel(double spacing) {
    const double body = 0.25, neck = 0.12, arms = 0.45, top = 0.7;
    Random random(3);
    ShirtPanel panel;
    TriangleMesh& mesh = panel.mesh;
    const auto even = [&](double low, double high) {
        const int parts = std::max(2, static_cast<int>(std::lround((high - low) / (row_ratio * spacing))));
        std::vector<double> heights;
        for (int i = 0; i <= parts; ++i) heights.push_back(low + (high - low) * i / parts);
        return heights;
    };
    const Row below = append_body(random, body, even(0.0, arms), panel);
    Row before = append_wide_row(random, body, arms, spacing, panel);
    Row middle;
    std::copy_if(before.begin(), before.end(), std::back_inserter(middle),
                 [&](int i) { return std::abs(mesh.vertices[i].x()) <= body; });
    zip(middle, below, mesh);
    append_seam(panel, [&](const Vec3& x) { return std::abs(x.x()) >= body; });
    const std::vector<double> heights = even(arms, top);
    for (std::size_t k = 1; k < heights.size(); ++k) {
        const Row row = append_wide_row(random, neck, heights[k], spacing, panel);
        zip(row, before, mesh);
        before = row;
        append_seam(panel, [&](const Vec3& x) { return k + 1 == heights.size() && std::abs(x.x()) >= neck; });
    }
    return panel;
}

/// The panel twice, a third of the spacing to the front and to the back, one vertex for both on a seam.
TriangleMesh shirt_of_spacing(double spacing) {
    const ShirtPanel panel = shirt_panel(spacing);
    TriangleMesh shirt = panel.mesh;
    std::vector<int> behind;
    for (std::size_t i = 0; i < panel.on_seam.size(); ++i) {
        behind.push_back(panel.on_seam[i] ? static_cast<int>(i) : static_cast<int>(shirt.vertices.size()));
        if (panel.on_seam[i]) continue;
        shirt.vertices.push_back(shirt.vertices[i] - Vec3(0.0, 0.0, spacing / 3.0));
        shirt.vertices[i].z() += spacing / 3.0;
    }
    for (const Triangle& t : panel.mesh.triangles) shirt.triangles.push_back({behind[t[0]], behind[t[2]], behind[t[1]]});
    return shirt;
}

/// The mesh whose spacing gives the requested number of vertices, found by the rule that their number goes with 1/spacing^2.
TriangleMesh with_vertices(int wished, double area, const std::function<TriangleMesh(double)>& of_spacing) {
    double spacing = std::sqrt(area / (row_ratio * wished));
    TriangleMesh mesh = of_spacing(spacing);
    for (int trial = 0; trial < 6 && std::abs(static_cast<double>(mesh.vertices.size()) / wished - 1.0) > 0.01; ++trial) {
        spacing *= std::sqrt(static_cast<double>(mesh.vertices.size()) / wished);
        mesh = of_spacing(spacing);
    }
    return mesh;
}

}  // namespace

TriangleMesh irregular_sheet(double size, int vertices) {
    return with_vertices(vertices, size * size, [size](double spacing) { return sheet_of_spacing(size, spacing); });
}

TriangleMesh tube_skirt(int vertices) { return with_vertices(vertices, 1.12, skirt_of_spacing); }

TriangleMesh t_shirt(int vertices) { return with_vertices(vertices, 1.0, shirt_of_spacing); }

TriangleMesh shuffled(const TriangleMesh& mesh) {
    Random random(4);
    std::vector<int> new_number(mesh.vertices.size());
    std::iota(new_number.begin(), new_number.end(), 0);
    for (std::size_t i = new_number.size(); i > 1; --i) {
        std::swap(new_number[i - 1], new_number[random.index(static_cast<int>(i))]);
    }
    TriangleMesh result{.vertices = mesh.vertices, .triangles = mesh.triangles};
    for (std::size_t i = 0; i < new_number.size(); ++i) result.vertices[new_number[i]] = mesh.vertices[i];
    for (Triangle& t : result.triangles) t = {new_number[t[0]], new_number[t[1]], new_number[t[2]]};
    return result;
}

int nearest_vertex(const TriangleMesh& mesh, const Vec3& point) {
    const auto nearer = [&point](const Vec3& a, const Vec3& b) { return (a - point).norm() < (b - point).norm(); };
    return static_cast<int>(std::min_element(mesh.vertices.begin(), mesh.vertices.end(), nearer) - mesh.vertices.begin());
}

double worst_aspect(const TriangleMesh& mesh) {
    double worst = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        worst = std::max(worst, longest * longest / (b - a).cross(c - a).norm());
    }
    return worst;
}

}  // namespace percale::test
