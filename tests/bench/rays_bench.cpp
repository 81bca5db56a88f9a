// SPDX-License-Identifier: GPL-3.0-or-later
// Rays a second in the sample office, beside what bare Embree gives on the same triangles for the same rays:
// the nearest hit, and whether two points see each other. The points of a link's rays lie as the solver lays
// them: from eight spots of a piece to eight spots of each of some others.
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <filesystem>

#include <geometry/rays.hpp>
#include <geometry/sampling.hpp>

namespace clerestory {
namespace {

using Segment = RayScene::Segment;
using Barrier = RayScene::Barrier;

const Building& office() {
  static const Building building = [] {
    const std::filesystem::path file = std::filesystem::path(CLERESTORY_SAMPLES) / "office/office.glb";
    Study study = studyOfModel(file);
    return makeBuilding(cleanScene(readModel(file, {})), study);
  }();
  return building;
}

const RayScene& officeRays() {
  static const RayScene rays(office().model, office().innerGlass);
  return rays;
}

/// Embree over all pieces of the office.
class BareScene {
 public:
  BareScene() : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    const Pieces& pieces = office().model.pieces;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
      const auto corners = pieces.polygons[piece];
      for (std::size_t i = 2; i < corners.size(); ++i)
        indices.insert(indices.end(), {corners[0], corners[i - 1], corners[i]});
    }
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), pieces.points.size()));
    for (const glm::dvec3& point : pieces.points) {
      const glm::vec3 local(point - officeRays().origin());
      for (int axis = 0; axis < 3; ++axis) *points++ = local[axis];
    }
    auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), indices.size() / 3));
    std::copy(indices.begin(), indices.end(), corners);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);  // as the program needs it: no leaks at edges
    rtcCommitScene(scene_);
  }
  BareScene(const BareScene&) = delete;
  BareScene& operator=(const BareScene&) = delete;
  ~BareScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  [[nodiscard]] RTCScene get() const { return scene_; }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

RTCScene bare() {
  static const BareScene scene;
  return scene.get();
}

constexpr std::uint32_t count = 1U << 16U;

/// From a point in the office's air to another.
std::vector<Segment> scatteredSegments() {
  std::vector<Segment> segments;
  const auto place = [](const Sequence& sequence, std::uint32_t i) {
    return glm::vec3(glm::dvec3(0.3 + 11.0 * static_cast<double>(sequence(i, 0)),
                                0.3 + 7.0 * static_cast<double>(sequence(i, 1)),
                                0.3 + 2.0 * static_cast<double>(sequence(i, 2))) -
                     officeRays().origin());
  };
  const Sequence from(1);
  const Sequence to(2);
  for (std::uint32_t i = 0; i < count; ++i) segments.push_back({place(from, i), place(to, i)});
  return segments;
}

/// Eight rays of each of eight links of a piece, then the next piece's.
std::vector<Segment> linkSegments() {
  const Pieces& pieces = office().model.pieces;
  const auto spot = [&](std::uint32_t piece, std::uint32_t i) {
    std::vector<glm::dvec3> corners;
    for (const std::uint32_t corner : pieces.polygons[piece]) corners.push_back(pieces.points[corner]);
    const Sequence sequence(piece);
    return glm::vec3(pointOnPolygon<glm::dvec3>(corners, sequence(i, 0), sequence(i, 1)) -
                     officeRays().origin());
  };
  std::vector<Segment> segments;
  std::uint64_t pick = 0;
  const auto next = [&] { return static_cast<std::uint32_t>(mixKey(++pick) % pieces.size()); };
  while (segments.size() < count) {
    const std::uint32_t receiver = next();
    for (int link = 0; link < 8; ++link) {
      const std::uint32_t sender = next();
      for (std::uint32_t i = 0; i < 8; ++i) segments.push_back({spot(receiver, i), spot(sender, i)});
    }
  }
  return segments;
}

RTCRay rayOf(const Segment& segment) {
  const glm::vec3 span = segment.to - segment.from;
  const float length_m = glm::length(span);
  const glm::vec3 direction = span / length_m;
  RTCRay ray{};
  ray.org_x = segment.from.x;
  ray.org_y = segment.from.y;
  ray.org_z = segment.from.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tnear = rayOffset_m;
  ray.tfar = length_m - rayOffset_m;
  ray.mask = ~0U;
  return ray;
}

/// Packets of N rays, from the same segments.
template <class Packet, int N>
std::vector<Packet> packetsOf(const std::vector<Segment>& segments) {
  std::vector<Packet> packets(segments.size() / N);
  for (std::size_t i = 0; i < packets.size() * N; ++i) {
    const RTCRay ray = rayOf(segments[i]);
    Packet& packet = packets[i / N];
    const std::size_t lane = i % N;
    packet.org_x[lane] = ray.org_x;
    packet.org_y[lane] = ray.org_y;
    packet.org_z[lane] = ray.org_z;
    packet.dir_x[lane] = ray.dir_x;
    packet.dir_y[lane] = ray.dir_y;
    packet.dir_z[lane] = ray.dir_z;
    packet.tnear[lane] = ray.tnear;
    packet.tfar[lane] = ray.tfar;
    packet.mask[lane] = ray.mask;
  }
  return packets;
}

void countRays(benchmark::State& state, std::size_t each) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(each));
}

using Segments = std::vector<Segment> (*)();

void occludedProgramSingly(benchmark::State& state, Segments make) {
  const std::vector<Segment> segments = make();
  for (auto _ : state) {
    for (const Segment& segment : segments)
      benchmark::DoNotOptimize(officeRays().occluded(segment.from, segment.to, Barrier::opaqueAndGlass));
  }
  countRays(state, segments.size());
}

void occludedProgram(benchmark::State& state, Segments make) {
  const std::vector<Segment> segments = make();
  std::vector<std::uint8_t> blocked(segments.size());
  for (auto _ : state) {
    for (std::size_t first = 0; first < segments.size(); first += 64)
      officeRays().occluded(std::span(segments).subspan(first, 64), Barrier::opaqueAndGlass,
                            std::span(blocked).subspan(first, 64));
    benchmark::DoNotOptimize(blocked.data());
  }
  countRays(state, segments.size());
}

void occludedBareSingly(benchmark::State& state, Segments make) {
  std::vector<RTCRay> rays;
  for (const Segment& segment : make()) rays.push_back(rayOf(segment));
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (auto _ : state) {
    for (RTCRay ray : rays) {
      rtcOccluded1(bare(), &context, &ray);
      benchmark::DoNotOptimize(ray.tfar);
    }
  }
  countRays(state, rays.size());
}

template <class Packet, int N>
void occludedBarePackets(benchmark::State& state, Segments make,
                         void (*trace)(const int*, RTCScene, RTCIntersectContext*, Packet*)) {
  const std::vector<Packet> packets = packetsOf<Packet, N>(make());
  alignas(64) int valid[N];
  std::fill(std::begin(valid), std::end(valid), -1);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (auto _ : state) {
    for (Packet packet : packets) {
      trace(valid, bare(), &context, &packet);
      benchmark::DoNotOptimize(packet.tfar[0]);
    }
  }
  countRays(state, packets.size() * N);
}

constexpr auto* occludedBareBy4 = occludedBarePackets<RTCRay4, 4>;
constexpr auto* occludedBareBy8 = occludedBarePackets<RTCRay8, 8>;
constexpr auto* occludedBareBy16 = occludedBarePackets<RTCRay16, 16>;

// Streams of 64 rays, as many as the links of one wave might have.
void occludedBareStreams(benchmark::State& state, Segments make) {
  std::vector<RTCRay> rays;
  for (const Segment& segment : make()) rays.push_back(rayOf(segment));
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  std::vector<RTCRay> own(64);
  for (auto _ : state) {
    for (std::size_t first = 0; first + 64 <= rays.size(); first += 64) {
      std::copy_n(rays.begin() + static_cast<std::ptrdiff_t>(first), 64, own.begin());
      rtcOccluded1M(bare(), &context, own.data(), 64, sizeof(RTCRay));
      benchmark::DoNotOptimize(own.data());
    }
  }
  countRays(state, rays.size() / 64 * 64);
}

void nearestProgram(benchmark::State& state) {
  const std::vector<Segment> segments = scatteredSegments();
  std::vector<glm::vec3> directions;
  for (const Segment& segment : segments) directions.push_back(glm::normalize(segment.to - segment.from));
  for (auto _ : state) {
    for (std::size_t i = 0; i < segments.size(); ++i)
      benchmark::DoNotOptimize(
          officeRays().nearest(segments[i].from, directions[i], Barrier::opaqueAndGlass));
  }
  countRays(state, segments.size());
}

void nearestBare(benchmark::State& state) {
  std::vector<RTCRayHit> queries;
  for (const Segment& segment : scatteredSegments()) {
    RTCRayHit query{};
    query.ray = rayOf(segment);
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    queries.push_back(query);
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (auto _ : state) {
    for (RTCRayHit query : queries) {
      rtcIntersect1(bare(), &context, &query);
      benchmark::DoNotOptimize(query.hit.primID);
    }
  }
  countRays(state, queries.size());
}

BENCHMARK(nearestProgram);
BENCHMARK(nearestBare);
#define CLERESTORY_OCCLUDED(name, segments)                           \
  BENCHMARK_CAPTURE(occludedProgramSingly, name, segments);           \
  BENCHMARK_CAPTURE(occludedProgram, name, segments);                 \
  BENCHMARK_CAPTURE(occludedBareSingly, name, segments);              \
  BENCHMARK_CAPTURE(occludedBareBy4, name, segments, rtcOccluded4);   \
  BENCHMARK_CAPTURE(occludedBareBy8, name, segments, rtcOccluded8);   \
  BENCHMARK_CAPTURE(occludedBareBy16, name, segments, rtcOccluded16); \
  BENCHMARK_CAPTURE(occludedBareStreams, name, segments);
CLERESTORY_OCCLUDED(scattered, scatteredSegments)
CLERESTORY_OCCLUDED(links, linkSegments)

}  // namespace
}  // namespace clerestory
