// SPDX-License-Identifier: GPL-3.0-or-later
// Reference illuminances of a daylit building by plain path tracing, straight from its OBJ file. Nothing of
// Clerestory is in it but Embree's triangles, so that an error of the program's is not one of its own.
//
// A path leaves a sensor, is scattered by Lambert's law at every polygon, passes or is mirrored by glass with
// Fresnel's probabilities, and ends where it meets the sky or the ground. At every corner a branch is sent to
// a pane as well, and what both find there is weighted by the density of both together. Where there is sun, a
// ray to a point of its disc leaves every corner, and another to its image in the panes.
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

/// Sky over an even ground of reflectance 0.2, and the sun.
struct Sky {
  double horizontal_lx, beam_lx;  ///< of the sky alone; normal to the beam
  Vector towardsSun;
  bool isClear;
  double scale = 1.0;
  static constexpr double groundReflectance = 0.2, sunRadius = 0.265 / 180.0 * pi;

  /// The traditional CIE overcast sky of 10,000 lx.
  static Sky overcast() { return Sky{10000.0, 0.0, {0.0, 0.0, 1.0}, false}.scaled(); }

  /// CIE S 011 type 12 with the sun of 21 March, 10 o'clock, as the tables by Radiance have it.
  static Sky clear() {
    const double altitude = 35.836 / 180.0 * pi, azimuth = 141.922 / 180.0 * pi;
    const Vector sun{std::cos(altitude) * std::sin(azimuth), std::cos(altitude) * std::cos(azimuth),
                     std::sin(altitude)};
    return Sky{7761.0, 69162.0, sun, true}.scaled();
  }

  /// Luminance of sky and ground. [cd/m²]
  [[nodiscard]] double luminance(Vector way) const {
    if (way.z < 0.0) return groundReflectance * (horizontal_lx + beam_lx * std::max(towardsSun.z, 0.0)) / pi;
    return scale * pattern(way);
  }

  /// A direction to the sun's disc.
  template <class Even, class Random>
  Vector ontoSun(Even& even, Random& random) const {
    const double away = std::tan(sunRadius) * std::sqrt(even(random));
    const double angle = 2.0 * pi * even(random);
    const Vector side = unit(cross({0.0, 0.0, 1.0}, towardsSun));
    return unit(towardsSun + away * std::cos(angle) * side +
                away * std::sin(angle) * cross(towardsSun, side));
  }

 private:
  [[nodiscard]] double pattern(Vector way) const {
    if (!isClear) return 1.0 + 2.0 * way.z;
    const double between = std::acos(std::clamp(dot(way, towardsSun), -1.0, 1.0));
    const double gradation = 1.0 - std::exp(-0.32 / std::max(way.z, 1e-6));
    return gradation * (1.0 + 10.0 * (std::exp(-3.0 * between) - std::exp(-1.5 * pi)) +
                        0.45 * std::cos(between) * std::cos(between));
  }

  /// Set to its horizontal illuminance by a sum over squared sines of the altitude and over azimuths.
  [[nodiscard]] Sky scaled() const {
    constexpr int rows = 1000, columns = 2000;
    double sum = 0.0;
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        const double high = std::sqrt((i + 0.5) / rows), flat = std::sqrt(1.0 - high * high);
        const double azimuth = 2.0 * pi * (j + 0.5) / columns;
        sum += pattern({flat * std::sin(azimuth), flat * std::cos(azimuth), high});
      }
    }
    Sky sky = *this;
    sky.scale = horizontal_lx / (pi * sum / (rows * columns));
    return sky;
  }
};

/// What a path brings: all of it; what came straight through the panes, by way of the outside at most; and
/// what had been in a room before, left it by the glass and came back.
struct Brought {
  double all_lx = 0.0, straight_lx = 0.0, returned_lx = 0.0;

  void add(double light_lx, int corners, int exits) {
    all_lx += light_lx;
    if (corners == 0) straight_lx += light_lx;
    if (exits > 1) returned_lx += light_lx;
  }
};

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
  Room(std::vector<Triangle> triangles, const Sky& sky)
      : triangles_(std::move(triangles)),
        sky_(sky),
        device_(rtcNewDevice(nullptr)),
        scene_(rtcNewScene(device_)) {
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
      panes_.push_back(
          {i, 0.5 * length(cross(own.b - own.a, own.c - own.a)), (1.0 / 3.0) * (own.a + own.b + own.c)});
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

  /// Illuminance by one path.
  template <class Random>
  [[nodiscard]] Brought path(Vector at, Vector normal, Random& random) const {
    std::uniform_real_distribution<double> even(0.0, 1.0);
    Brought sum;
    if (sky_.beam_lx > 0.0) sum.add(fromSun(at, normal, even, random), 0, 1);
    Way way{at, normal, pi};
    branchToPane(way, sum, even, random);
    scatter(way, even, random);
    follow(way, sum, even, random);
    return sum;
  }

 private:
  struct Pane {
    std::size_t triangle;
    double area_m2;
    Vector centre;
  };

  /// A path on its way.
  struct Way {
    Vector at, direction;  ///< the surface's normal where it is still to be scattered
    double weight;         ///< of what it meets: lx for each cd/m²
    double ofPane = 1.0;   ///< of a pane, if that is what it meets first: the branches' part is taken off
    int corners = 0;       ///< in rooms
    int exits = 0;         ///< from rooms, by glass
    bool isIndoors = true;
  };

  template <class Even, class Random>
  void follow(Way way, Brought& sum, Even& even, Random& random) const {
    for (;;) {
      double distance_m = 0.0;
      const Triangle* met = nearest(way.at, way.direction, distance_m);
      if (met == nullptr) {
        sum.add(way.weight * sky_.luminance(way.direction), way.corners, way.exits);
        return;
      }
      way.at = way.at + distance_m * way.direction;
      const double cosine = dot(way.direction, met->normal);
      if (met->material.isGlass()) {
        const auto [passes, returns] = sheet_.at(std::abs(cosine));
        way.weight *= (passes + returns) * way.ofPane;
        way.ofPane = 1.0;
        if (even(random) * (passes + returns) > passes) {
          way.direction = way.direction - 2.0 * cosine * met->normal;
        } else {
          way.exits += way.isIndoors ? 1 : 0;
          way.isIndoors = !way.isIndoors;
        }
        continue;
      }
      way.direction = (cosine < 0.0 ? 1.0 : -1.0) * met->normal;
      way.corners += way.isIndoors ? 1 : 0;
      if (sky_.beam_lx > 0.0) {
        const double sun_lx = fromSun(way.at, way.direction, even, random);
        sum.add(way.weight * met->material.reflectance * sun_lx / pi, way.corners,
                way.exits + (way.isIndoors ? 1 : 0));
      }
      if (even(random) >= met->material.reflectance) return;
      branchToPane(way, sum, even, random);
      scatter(way, even, random);
    }
  }

  /// Follows a branch to a pane, if nothing is before it.
  template <class Even, class Random>
  void branchToPane(Way way, Brought& sum, Even& even, Random& random) const {
    const Vector normal = way.direction;
    way.direction = unit(onPane(way.at, even, random) - way.at);
    const double cosine = dot(way.direction, normal);
    if (cosine <= 0.0) return;
    double distance_m = 0.0;
    const Triangle* met = nearest(way.at, way.direction, distance_m);
    if (met == nullptr || !met->material.isGlass()) return;
    way.weight *= cosine / pi / (cosine / pi + paneDensity(way.at, way.direction));
    way.ofPane = 1.0;
    follow(way, sum, even, random);
  }

  /// Turns a way from a surface's normal to a direction by the cosine.
  template <class Even, class Random>
  void scatter(Way& way, Even& even, Random& random) const {
    const Vector normal = way.direction;
    const double squared = even(random);
    const double angle = 2.0 * pi * even(random);
    const Vector side =
        unit(cross(std::abs(normal.z) < 0.5 ? Vector{0.0, 0.0, 1.0} : Vector{1.0, 0.0, 0.0}, normal));
    way.direction = std::sqrt(squared) * std::cos(angle) * side +
                    std::sqrt(squared) * std::sin(angle) * cross(normal, side) +
                    std::sqrt(1.0 - squared) * normal;
    const double own = dot(way.direction, normal) / pi;
    way.ofPane = own / (own + paneDensity(way.at, way.direction));
  }

  /// Illuminance by a point of the sun's disc, through panes, and by its image in an upright pane. [lx]
  template <class Even, class Random>
  double fromSun(Vector at, Vector normal, Even& even, Random& random) const {
    const Vector sun = sky_.ontoSun(even, random);
    double sum = std::max(dot(sun, normal), 0.0);
    if (sum > 0.0) sum *= passedTo(at, sun);
    for (const Vector across : {Vector{1.0, 0.0, 0.0}, Vector{0.0, 1.0, 0.0}}) {
      const Vector way = sun - 2.0 * dot(sun, across) * across;
      const double cosine = dot(way, normal);
      double distance_m = 0.0;
      if (cosine <= 0.0 || !meetsPane(at, way, across)) continue;
      const Triangle* met = nearest(at, way, distance_m);
      if (met == nullptr || !met->material.isGlass() || std::abs(dot(met->normal, across)) < 0.999) continue;
      sum += cosine * sheet_.at(std::abs(dot(way, across)))[1] * passedTo(at + distance_m * way, sun);
    }
    return sky_.beam_lx * sum;
  }

  /// Transmittance of all panes on the way out; 0 where something stands in it.
  [[nodiscard]] double passedTo(Vector at, Vector way) const {
    double share = 1.0;
    for (;;) {
      double distance_m = 0.0;
      const Triangle* met = nearest(at, way, distance_m);
      if (met == nullptr) return share;
      if (!met->material.isGlass()) return 0.0;
      share *= sheet_.at(std::abs(dot(way, met->normal)))[0];
      at = at + distance_m * way;
    }
  }

  /// Whether a ray would meet a pane that faces a way, were nothing else there.
  [[nodiscard]] bool meetsPane(Vector at, Vector way, Vector facing) const {
    return std::any_of(panes_.begin(), panes_.end(), [&](const Pane& pane) {
      const Triangle& own = triangles_[pane.triangle];
      return std::abs(dot(own.normal, facing)) > 0.999 && distanceTo(own, at, way) > 0.0;
    });
  }

  /// How far a triangle is along a ray; 0 where the ray does not meet it.
  static double distanceTo(const Triangle& own, Vector at, Vector way) {
    const double distance_m = dot(own.a - at, own.normal) / dot(way, own.normal);
    if (!(distance_m > 0.0)) return 0.0;
    const Vector point = at + distance_m * way;
    const bool isInside = dot(cross(own.b - own.a, point - own.a), own.normal) >= 0.0 &&
                          dot(cross(own.c - own.b, point - own.b), own.normal) >= 0.0 &&
                          dot(cross(own.a - own.c, point - own.c), own.normal) >= 0.0;
    return isInside ? distance_m : 0.0;
  }

  /// Panes are drawn by how near they are, hidden or not.
  static double chanceOf(const Pane& pane, Vector at) {
    const Vector towards = pane.centre - at;
    return pane.area_m2 / (pane.area_m2 + dot(towards, towards));
  }

  template <class Even, class Random>
  Vector onPane(Vector at, Even& even, Random& random) const {
    double chances = 0.0;
    for (const Pane& pane : panes_) chances += chanceOf(pane, at);
    double chance = even(random) * chances;
    auto drawn = panes_.begin();
    while (drawn + 1 != panes_.end() && chance >= chanceOf(*drawn, at)) chance -= chanceOf(*drawn++, at);
    const Triangle& own = triangles_[drawn->triangle];
    const double u = std::sqrt(even(random));
    const double v = even(random);
    return own.a + u * (1.0 - v) * (own.b - own.a) + u * v * (own.c - own.a);
  }

  /// Density over solid angle of directions drawn to panes. [1/sr]
  [[nodiscard]] double paneDensity(Vector at, Vector way) const {
    double density = 0.0;
    double chances = 0.0;
    for (const Pane& pane : panes_) {
      const Triangle& own = triangles_[pane.triangle];
      const double chance = chanceOf(pane, at);
      chances += chance;
      const double distance_m = distanceTo(own, at, way);
      if (distance_m > 0.0)
        density += chance * distance_m * distance_m / (std::abs(dot(way, own.normal)) * pane.area_m2);
    }
    return density / chances;
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
  Sky sky_;
  std::vector<Pane> panes_;
  Sheet sheet_{1.0};
  RTCDevice device_;
  RTCScene scene_;
};

struct Sensor {
  Vector at, normal;
  Brought mean;
  double deviation_lx = 0.0;
};

/// Paths until the mean's standard deviation is as asked, in blocks.
void measure(const Room& room, double deviation, std::size_t number, Sensor& sensor) {
  constexpr std::uint64_t block = 16384;
  constexpr std::uint64_t most = 2000 * block;
  std::mt19937_64 random(0xc1e7e5 + number);
  Brought sum;
  double squares = 0.0;
  for (std::uint64_t count = block; count <= most; count += block) {
    for (std::uint64_t i = 0; i < block; ++i) {
      const Brought own = room.path(sensor.at, sensor.normal, random);
      sum.all_lx += own.all_lx;
      sum.straight_lx += own.straight_lx;
      sum.returned_lx += own.returned_lx;
      squares += own.all_lx * own.all_lx;
    }
    const auto paths = static_cast<double>(count);
    sensor.mean = {sum.all_lx / paths, sum.straight_lx / paths, sum.returned_lx / paths};
    const double mean_lx = sensor.mean.all_lx;
    sensor.deviation_lx = std::sqrt((squares / paths - mean_lx * mean_lx) / paths);
    if (sensor.deviation_lx <= deviation * mean_lx) return;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string sky = argc == 5 ? argv[4] : "overcast";
  if (argc < 4 || argc > 5 || (sky != "overcast" && sky != "clear")) {
    std::cerr << "usage: reference_paths MODEL.obj SENSORS.csv DEVIATION [overcast|clear] > REFERENCE.csv\n"
                 "SENSORS.csv: x,y,z in metres, and nx,ny,nz if it does not look up; DEVIATION: relative, of "
                 "each mean\n";
    return 1;
  }
  const Room room(readObj(argv[1]), sky == "clear" ? Sky::clear() : Sky::overcast());
  std::vector<Sensor> sensors;
  std::ifstream stream(argv[2]);
  for (std::string line; std::getline(stream, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    Sensor sensor;
    if (!(words >> sensor.at.x >> sensor.at.y >> sensor.at.z)) continue;  // a header
    if (!(words >> sensor.normal.x >> sensor.normal.y >> sensor.normal.z)) sensor.normal = {0.0, 0.0, 1.0};
    sensors.push_back(sensor);
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
  std::cout << "x,y,z,lux,standard_deviation_lux,straight_lux,returned_lux\n";
  for (const Sensor& sensor : sensors)
    std::cout << sensor.at.x << ',' << sensor.at.y << ',' << sensor.at.z << ',' << sensor.mean.all_lx << ','
              << sensor.deviation_lx << ',' << sensor.mean.straight_lx << ',' << sensor.mean.returned_lx
              << '\n';
}
