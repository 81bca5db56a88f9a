// SPDX-License-Identifier: GPL-3.0-or-later
// Reference illuminances of a daylit room by plain path tracing, straight from its OBJ file. Nothing of
// Clerestory is in it but Embree's triangles, so that an error of the program's is not one of its own.
//
// A path leaves a sensor, is scattered by Lambert's law at every polygon, passes or is mirrored by glass with
// Fresnel's probabilities, and ends where it meets the sky or the ground. Half of its directions are drawn by
// the cosine, half towards a pane, weighted by the density of both together.
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace {

using std::numbers::pi;

struct Vector {
  double x = 0.0, y = 0.0, z = 0.0;
  friend Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vector operator*(double f, Vector v) { return {f * v.x, f * v.y, f * v.z}; }
};
double dot(Vector a, Vector b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vector cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(Vector v) {
  return std::sqrt(dot(v, v));
}
Vector unit(Vector v) {
  return (1.0 / length(v)) * v;
}

struct Material {
  double reflectance = 0.0, transmittance = 0.0;
  [[nodiscard]] bool isGlass() const { return transmittance > 0.0; }
};

struct Triangle {
  Vector a, b, c, normal;
  Material material;
};

/// Transmittance and reflectance of a sheet of glass for unpolarised light.
struct Sheet {
  double internal;  ///< transmittance of its bulk, straight through
  static constexpr double index = 1.52;

  static Sheet of(double normalTransmittance) {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (Sheet{middle}.at(1.0)[0] < normalTransmittance ? low : high) = middle;
    }
    return {low};
  }
  [[nodiscard]] std::array<double, 2> at(double cosine) const {
    const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
    const double across = (cosine - index * inside) / (cosine + index * inside);
    const double along = (index * cosine - inside) / (index * cosine + inside);
    const double passed = std::pow(internal, 1.0 / inside);
    std::array<double, 2> sum{};
    for (const double face : {across * across, along * along}) {
      const double once = (1.0 - face) * (1.0 - face) / (1.0 - face * face * passed * passed);
      sum[0] += 0.5 * once * passed;
      sum[1] += 0.5 * (face + once * face * passed * passed);
    }
    return sum;
  }
};

/// Traditional CIE overcast sky of 10,000 lx over an even ground of reflectance 0.2. [cd/m²]
double luminance(Vector direction) {
  constexpr double horizontal_lx = 10000.0;
  if (direction.z < 0.0) return 0.2 * horizontal_lx / pi;
  return horizontal_lx * 9.0 / (7.0 * pi) * (1.0 + 2.0 * direction.z) / 3.0;
}

std::map<std::string, Material> readMaterials(const std::string& file) {
  std::map<std::string, Material> materials;
  std::ifstream stream(file);
  std::string name;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "newmtl") words >> name;
    if (word == "Kd") words >> materials[name].reflectance;
    if (word == "Tf") words >> materials[name].transmittance;
  }
  return materials;
}

std::vector<Triangle> readObj(const std::string& file) {
  std::ifstream stream(file);
  std::map<std::string, Material> materials;
  Material material;
  std::vector<Vector> vertices;
  std::vector<Triangle> triangles;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "mtllib") {
      words >> word;
      materials = readMaterials(file.substr(0, file.find_last_of('/') + 1) + word);
    } else if (word == "usemtl") {
      words >> word;
      material = materials.at(word);
    } else if (word == "v") {
      Vector v;
      words >> v.x >> v.y >> v.z;
      vertices.push_back(v);
    } else if (word == "f") {
      std::vector<Vector> corners;
      while (words >> word) corners.push_back(vertices.at(std::stoul(word) - 1));
      for (std::size_t i = 2; i < corners.size(); ++i) {
        const Vector normal = unit(cross(corners[i - 1] - corners[0], corners[i] - corners[0]));
        triangles.push_back({corners[0], corners[i - 1], corners[i], normal, material});
      }
    }
  }
  return triangles;
}

class Room {
 public:
  explicit Room(std::vector<Triangle> triangles)
      : triangles_(std::move(triangles)), device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corners = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * triangles_.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles_.size()));
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const Triangle& own = triangles_[i];
      for (const Vector& corner : {own.a, own.b, own.c}) {
        for (const double value : {corner.x, corner.y, corner.z}) *corners++ = static_cast<float>(value);
      }
      for (std::size_t k = 0; k < 3; ++k) *indices++ = static_cast<std::uint32_t>(3 * i + k);
      if (!own.material.isGlass()) continue;
      panes_.push_back(i);
      paneArea_ += 0.5 * length(cross(own.b - own.a, own.c - own.a));
      sheet_ = Sheet::of(own.material.transmittance);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~Room() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

  /// Illuminance by one path. [lx]
  template <class Random>
  [[nodiscard]] double path(Vector at, Vector normal, Random& random) const {
    std::uniform_real_distribution<double> even(0.0, 1.0);
    double weight = pi;
    Vector way = scattered(at, normal, weight, even, random);
    while (weight > 0.0) {
      double distance_m = 0.0;
      const Triangle* met = nearest(at, way, distance_m);
      if (met == nullptr) return weight * luminance(way);
      at = at + distance_m * way;
      const double cosine = dot(way, met->normal);
      if (met->material.isGlass()) {
        const auto [passes, returns] = sheet_.at(std::abs(cosine));
        weight *= passes + returns;
        if (even(random) * (passes + returns) > passes) way = way - 2.0 * cosine * met->normal;
        continue;
      }
      if (even(random) >= met->material.reflectance) return 0.0;
      way = scattered(at, (cosine < 0.0 ? 1.0 : -1.0) * met->normal, weight, even, random);
    }
    return 0.0;
  }

 private:
  template <class Even, class Random>
  Vector scattered(Vector at, Vector normal, double& weight, Even& even, Random& random) const {
    Vector way;
    if (even(random) < 0.5) {
      const double squared = even(random);
      const double angle = 2.0 * pi * even(random);
      const Vector side =
          unit(cross(std::abs(normal.z) < 0.5 ? Vector{0.0, 0.0, 1.0} : Vector{1.0, 0.0, 0.0}, normal));
      way = std::sqrt(squared) * std::cos(angle) * side +
            std::sqrt(squared) * std::sin(angle) * cross(normal, side) + std::sqrt(1.0 - squared) * normal;
    } else {
      way = unit(onPane(even, random) - at);
    }
    const double cosine = dot(way, normal);
    if (cosine <= 0.0) weight = 0.0;
    const double density = 0.5 * cosine / pi + 0.5 * paneDensity(at, way);
    weight *= cosine / pi / density;
    return way;
  }

  template <class Even, class Random>
  Vector onPane(Even& even, Random& random) const {
    double area = even(random) * paneArea_;
    for (const std::size_t pane : panes_) {
      const Triangle& own = triangles_[pane];
      area -= 0.5 * length(cross(own.b - own.a, own.c - own.a));
      if (area > 0.0 && pane != panes_.back()) continue;
      const double u = std::sqrt(even(random));
      const double v = even(random);
      return own.a + u * (1.0 - v) * (own.b - own.a) + u * v * (own.c - own.a);
    }
    return {};
  }

  /// Density over solid angle of directions drawn towards the panes, which may be hidden. [1/sr]
  [[nodiscard]] double paneDensity(Vector at, Vector way) const {
    double density = 0.0;
    for (const std::size_t pane : panes_) {
      const Triangle& own = triangles_[pane];
      const double cosine = dot(way, own.normal);
      const double distance_m = dot(own.a - at, own.normal) / cosine;
      if (!(distance_m > 0.0)) continue;
      const Vector point = at + distance_m * way;
      const bool isInside = dot(cross(own.b - own.a, point - own.a), own.normal) >= 0.0 &&
                            dot(cross(own.c - own.b, point - own.b), own.normal) >= 0.0 &&
                            dot(cross(own.a - own.c, point - own.c), own.normal) >= 0.0;
      if (isInside) density += distance_m * distance_m / (std::abs(cosine) * paneArea_);
    }
    return density;
  }

  const Triangle* nearest(Vector at, Vector way, double& distance_m) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(at.x);
    ray.ray.org_y = static_cast<float>(at.y);
    ray.ray.org_z = static_cast<float>(at.z);
    ray.ray.dir_x = static_cast<float>(way.x);
    ray.ray.dir_y = static_cast<float>(way.y);
    ray.ray.dir_z = static_cast<float>(way.z);
    ray.ray.tnear = 1e-4F;
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0U;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return nullptr;
    distance_m = static_cast<double>(ray.ray.tfar);
    return &triangles_[ray.hit.primID];
  }

  std::vector<Triangle> triangles_;
  std::vector<std::size_t> panes_;
  double paneArea_ = 0.0;
  Sheet sheet_{1.0};
  RTCDevice device_;
  RTCScene scene_;
};

struct Sensor {
  Vector at;
  double mean_lx = 0.0, deviation_lx = 0.0;
};

/// Paths until the mean's standard deviation is as asked, in blocks.
void measure(const Room& room, double deviation, std::size_t number, Sensor& sensor) {
  constexpr std::uint64_t block = 16384;
  constexpr std::uint64_t most = 2000 * block;
  std::mt19937_64 random(0xc1e7e5 + number);
  double sum = 0.0, squares = 0.0;
  for (std::uint64_t count = block; count <= most; count += block) {
    for (std::uint64_t i = 0; i < block; ++i) {
      const double own = room.path(sensor.at, {0.0, 0.0, 1.0}, random);
      sum += own;
      squares += own * own;
    }
    const auto paths = static_cast<double>(count);
    sensor.mean_lx = sum / paths;
    sensor.deviation_lx = std::sqrt((squares / paths - sensor.mean_lx * sensor.mean_lx) / paths);
    if (sensor.deviation_lx <= deviation * sensor.mean_lx) return;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: reference_paths MODEL.obj SENSORS.csv DEVIATION > REFERENCE.csv\n"
                 "SENSORS.csv: x,y,z in metres, looking up; DEVIATION: relative, of each mean\n";
    return 1;
  }
  const Room room(readObj(argv[1]));
  std::vector<Sensor> sensors;
  std::ifstream stream(argv[2]);
  for (std::string line; std::getline(stream, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    Sensor sensor;
    if (words >> sensor.at.x >> sensor.at.y >> sensor.at.z) sensors.push_back(sensor);
  }
  const double deviation = std::stod(argv[3]);
  std::vector<std::thread> threads;
  const std::size_t count = std::max(std::thread::hardware_concurrency(), 1U);
  for (std::size_t first = 0; first < count; ++first) {
    threads.emplace_back([&, first] {
      for (std::size_t i = first; i < sensors.size(); i += count) measure(room, deviation, i, sensors[i]);
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::cout << "x,y,z,lux,standard_deviation_lux\n";
  for (const Sensor& sensor : sensors)
    std::cout << sensor.at.x << ',' << sensor.at.y << ',' << sensor.at.z << ',' << sensor.mean_lx << ','
              << sensor.deviation_lx << '\n';
}
