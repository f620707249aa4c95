#include "picture/ray_tree.h"

#ifdef PERCALE_HAS_PICTURES
#include <embree3/rtcore.h>
#endif

#include "percale/error.h"
#include "report/image.h"

namespace percale::scenes {

#ifdef PERCALE_HAS_PICTURES

struct RayTree::Tree {
    Vec3 middle = Vec3::Zero();  // m, where the tree has its origin
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    ~Tree() {
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }
};

namespace {

void check_device(RTCDevice device) {
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
        throw SceneError("the tree of a picture cannot be made: Embree lacks memory");
}

Vec3 middle_of(std::span<const ShownShape> shapes) {
    Eigen::AlignedBox3d box;
    for (const ShownShape& shape : shapes)
        for (const Vec3& x : shape.mesh.vertices) box.extend(x);
    return box.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(box.center());
}

/// Geometry number k is shape number k.
void attach_shape(RTCDevice device, RTCScene scene, const ShownShape& shape, const Vec3& middle) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corner = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), shape.mesh.vertices.size()));
    auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), shape.mesh.triangles.size()));
    check_device(device);
    for (const Vec3& x : shape.mesh.vertices)
        for (int axis = 0; axis < 3; ++axis) *corner++ = static_cast<float>(x[axis] - middle[axis]);
    for (const Triangle& triangle : shape.mesh.triangles)
        for (const int vertex : triangle) *index++ = static_cast<unsigned>(vertex);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

RTCRay ray_of(const Vec3& origin, const Vec3& direction, double reach) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(origin.x());
    ray.org_y = static_cast<float>(origin.y());
    ray.org_z = static_cast<float>(origin.z());
    ray.dir_x = static_cast<float>(direction.x());
    ray.dir_y = static_cast<float>(direction.y());
    ray.dir_z = static_cast<float>(direction.z());
    ray.tfar = static_cast<float>(reach);
    ray.mask = 0xffffffffu;
    return ray;
}

}  // namespace

RayTree::RayTree(std::span<const ShownShape> shapes) : tree_(std::make_unique<Tree>()) {
    tree_->middle = middle_of(shapes);
    // One thread makes the tree, so that it is the same on all machines of one kind.
    tree_->device = rtcNewDevice("threads=1,set_affinity=0");
    if (tree_->device == nullptr) throw SceneError("the tree of a picture cannot be made: Embree does not start");
    tree_->scene = rtcNewScene(tree_->device);
    rtcSetSceneFlags(tree_->scene, RTC_SCENE_FLAG_ROBUST);
    for (const ShownShape& shape : shapes) attach_shape(tree_->device, tree_->scene, shape, tree_->middle);
    rtcCommitScene(tree_->scene);
    check_device(tree_->device);
}

RayTree::~RayTree() = default;

RayHit RayTree::first_hit(const Vec3& origin, const Vec3& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit found{};
    found.ray = ray_of(origin - tree_->middle, direction, std::numeric_limits<double>::infinity());
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(tree_->scene, &context, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {static_cast<int>(found.hit.geomID), static_cast<int>(found.hit.primID), found.hit.u, found.hit.v,
            static_cast<double>(found.ray.tfar)};
}

bool RayTree::blocked(const Vec3& origin, const Vec3& direction, double reach) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = ray_of(origin - tree_->middle, direction, reach);
    rtcOccluded1(tree_->scene, &context, &ray);
    return ray.tfar < 0.0f;
}

#else

struct RayTree::Tree {};

RayTree::RayTree(std::span<const ShownShape>) { throw SceneError(pictures_missing()); }
RayTree::~RayTree() = default;
RayHit RayTree::first_hit(const Vec3&, const Vec3&) const { return {}; }
bool RayTree::blocked(const Vec3&, const Vec3&, double) const { return false; }

#endif

}  // namespace percale::scenes
