// SPDX-License-Identifier: GPL-3.0-or-later
// Embree behind RayScene: opaque pieces, pieces with domain-bounding glass, and inner glass, one scene each.
#include <embree3/rtcore.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

#include <geometry/rays.hpp>

namespace clerestory {
namespace {

constexpr std::size_t packetWidth = 8;

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceHandle = std::unique_ptr<RTCDeviceTy, DeviceRelease>;
using SceneHandle = std::unique_ptr<RTCSceneTy, SceneRelease>;

/// The chosen pieces as fans of triangles; `owner` tells each triangle's piece.
struct TriangleScene {
  SceneHandle scene;
  std::vector<std::uint32_t> owner;
};

TriangleScene buildScene(RTCDevice device, const Pieces& pieces, const glm::dvec3& origin,
                         const std::vector<std::uint32_t>& chosen) {
  TriangleScene result;
  result.scene.reset(rtcNewScene(device));
  rtcSetSceneFlags(result.scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(result.scene.get(), RTC_BUILD_QUALITY_HIGH);
  std::size_t triangles = 0;
  for (const std::uint32_t piece : chosen) triangles += pieces.polygons[piece].size() - 2;

  if (triangles > 0) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), pieces.points.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles));
    if (vertices == nullptr || indices == nullptr) throw MachineError("no memory for the ray structure");
    for (const glm::dvec3& point : pieces.points) {
      const glm::vec3 local(point - origin);
      *vertices++ = local.x;
      *vertices++ = local.y;
      *vertices++ = local.z;
    }
    for (const std::uint32_t piece : chosen) {
      const auto corners = pieces.polygons[piece];
      for (std::size_t i = 2; i < corners.size(); ++i) {
        *indices++ = corners[0];
        *indices++ = corners[i - 1];
        *indices++ = corners[i];
        result.owner.push_back(piece);
      }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(result.scene.get(), geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(result.scene.get());
  return result;
}

RTCRay makeRay(const glm::vec3& from, const glm::vec3& direction, float near_m, float far_m) {
  RTCRay ray{};
  ray.org_x = from.x;
  ray.org_y = from.y;
  ray.org_z = from.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tnear = near_m;
  ray.tfar = far_m;
  ray.mask = ~0U;
  return ray;
}

void setRay(RTCRay8& rays, std::size_t i, const glm::vec3& from, const glm::vec3& direction, float near_m,
            float far_m) {
  rays.org_x[i] = from.x;
  rays.org_y[i] = from.y;
  rays.org_z[i] = from.z;
  rays.dir_x[i] = direction.x;
  rays.dir_y[i] = direction.y;
  rays.dir_z[i] = direction.z;
  rays.tnear[i] = near_m;
  rays.tfar[i] = far_m;
  rays.mask[i] = ~0U;
}

}  // namespace

struct RayScene::Embree {
  DeviceHandle device;
  TriangleScene opaque, barriers, innerGlass;
  glm::dvec3 origin{0.0};
  std::vector<glm::vec3> normal;  // #pieces

  [[nodiscard]] Hit hitOf(std::uint32_t piece, float distance_m, const glm::vec3& direction) const {
    return {piece, distance_m, glm::dot(normal[piece], direction) < 0.0F};
  }
  [[nodiscard]] const TriangleScene& of(Barrier barrier) const {
    return barrier == Barrier::opaque ? opaque : barriers;
  }
  [[nodiscard]] bool stops(RTCRay ray, Barrier barrier) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(of(barrier).scene.get(), &context, &ray);
    return ray.tfar < 0.0F;
  }
};

RayScene::RayScene(const CleanModel& model, const std::vector<bool>& innerGlass)
    : embree_(std::make_unique<Embree>()) {
  // No "threads=1" here: through oneTBB it would hold the whole program to one thread.
  embree_->device.reset(rtcNewDevice(nullptr));
  if (!embree_->device) throw MachineError("the ray tracer (Embree) could not be started");

  const Pieces& pieces = model.pieces;
  glm::dvec3 low(1e300);
  glm::dvec3 high(-1e300);
  for (const glm::dvec3& point : pieces.points) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  embree_->origin = pieces.points.empty() ? glm::dvec3(0.0) : glm::round(0.5 * (low + high));

  embree_->normal.assign(pieces.normal.begin(), pieces.normal.end());

  std::vector<std::uint32_t> opaque;
  std::vector<std::uint32_t> barriers;
  std::vector<std::uint32_t> inner;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    const bool isInner = !innerGlass.empty() && innerGlass[piece];
    if (!model.materials[pieces.material[piece]].glazing) opaque.push_back(piece);
    (isInner ? inner : barriers).push_back(piece);
  }
  const RTCDevice device = embree_->device.get();
  embree_->opaque = buildScene(device, pieces, embree_->origin, opaque);
  embree_->barriers = buildScene(device, pieces, embree_->origin, barriers);
  embree_->innerGlass = buildScene(device, pieces, embree_->origin, inner);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

glm::dvec3 RayScene::origin() const {
  return embree_->origin;
}

RayScene::Hit RayScene::nearest(const glm::vec3& from, const glm::vec3& direction, Barrier barrier,
                                float limit_m) const {
  const TriangleScene& triangles = embree_->of(barrier);
  RTCRayHit query{};
  query.ray = makeRay(from, direction, 0.0F, limit_m);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(triangles.scene.get(), &context, &query);

  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return embree_->hitOf(triangles.owner[query.hit.primID], query.ray.tfar, direction);
}

void RayScene::nearest(std::span<const Ray> rays, Barrier barrier, std::span<Hit> hits, Course course) const {
  const TriangleScene& triangles = embree_->of(barrier);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (course == Course::alike) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (std::size_t first = 0; first < rays.size(); first += packetWidth) {
    const std::size_t count = std::min(packetWidth, rays.size() - first);
    alignas(32) RTCRayHit8 query{};
    alignas(32) int valid[packetWidth] = {};
    for (std::size_t i = 0; i < count; ++i) {
      const Ray& ray = rays[first + i];
      valid[i] = -1;
      setRay(query.ray, i, ray.from, ray.direction, 0.0F, std::numeric_limits<float>::infinity());
      query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, triangles.scene.get(), &context, &query);
    for (std::size_t i = 0; i < count; ++i) {
      const bool isMet = query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
      hits[first + i] = isMet ? embree_->hitOf(triangles.owner[query.hit.primID[i]], query.ray.tfar[i],
                                               rays[first + i].direction)
                              : Hit{};
    }
  }
}

bool RayScene::meetsAny(const glm::vec3& from, const glm::vec3& direction, Barrier barrier,
                        float limit_m) const {
  return embree_->stops(makeRay(from, direction, 0.0F, limit_m), barrier);
}

bool RayScene::occluded(const glm::vec3& from, const glm::vec3& to, Barrier barrier) const {
  const glm::vec3 span = to - from;
  const float length_m = glm::length(span);
  if (length_m <= 2.0F * rayOffset_m) return false;
  return embree_->stops(makeRay(from, span / length_m, rayOffset_m, length_m - rayOffset_m), barrier);
}

void RayScene::occluded(std::span<const Segment> segments, Barrier barrier,
                        std::span<std::uint8_t> blocked) const {
  const RTCScene scene = embree_->of(barrier).scene.get();
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (std::size_t first = 0; first < segments.size(); first += packetWidth) {
    const std::size_t count = std::min(packetWidth, segments.size() - first);
    if (count == 1) {
      blocked[first] = occluded(segments[first].from, segments[first].to, barrier) ? 1 : 0;
      return;
    }
    alignas(32) RTCRay8 rays{};
    alignas(32) int valid[packetWidth] = {};
    for (std::size_t i = 0; i < count; ++i) {
      const glm::vec3 span = segments[first + i].to - segments[first + i].from;
      const float length_m = glm::length(span);
      blocked[first + i] = 0;
      if (length_m <= 2.0F * rayOffset_m) continue;
      valid[i] = -1;
      setRay(rays, i, segments[first + i].from, span / length_m, rayOffset_m, length_m - rayOffset_m);
    }
    rtcOccluded8(valid, scene, &context, &rays);
    for (std::size_t i = 0; i < count; ++i) {
      if (valid[i] != 0 && rays.tfar[i] < 0.0F) blocked[first + i] = 1;
    }
  }
}

std::vector<std::uint32_t> RayScene::innerGlassBetween(const glm::vec3& from, const glm::vec3& to,
                                                       std::size_t limit) const {
  std::vector<std::uint32_t> panes;
  const glm::vec3 span = to - from;
  const float length_m = glm::length(span);
  float start_m = rayOffset_m;
  while (panes.size() < limit && start_m < length_m - rayOffset_m) {
    RTCRayHit query{};
    query.ray = makeRay(from, span / length_m, start_m, length_m - rayOffset_m);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(embree_->innerGlass.scene.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
    const std::uint32_t pane = embree_->innerGlass.owner[query.hit.primID];
    if (panes.empty() || panes.back() != pane) panes.push_back(pane);
    start_m = query.ray.tfar + rayOffset_m;
  }
  return panes;
}

bool RayScene::hasInnerGlass() const {
  return !embree_->innerGlass.owner.empty();
}

}  // namespace clerestory
