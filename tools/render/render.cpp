#include "tools/render/render.h"

#include <embree3/rtcore.h>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "tools/file/failure.h"
#include "tools/render/render_camera.h"
#include "tools/render/render_mesh.h"
#include "tools/render/render_sampling.h"

namespace plc::tools {

namespace {

// Rays of a pixel, each with a ray to the key light and rays for the ambient light. 9 and 3 leave
// no visible grain at 1200 x 1200.
constexpr int kGrid = 3;  // kGrid^2 rays
constexpr int kAmbientRays = 3;

// Linear colours.
constexpr Vec3f kBone = {0.86F, 0.78F, 0.64F};
constexpr Vec3f kTop = {0.155F, 0.165F, 0.18F};  // of the background
constexpr Vec3f kBottom = {0.045F, 0.05F, 0.055F};
constexpr Vec3f kKey = {0.80F, 0.77F, 0.72F};
constexpr Vec3f kFill = {0.13F, 0.15F, 0.19F};
constexpr Vec3f kAmbient = {0.36F, 0.37F, 0.39F};

// Directions to the lights in the camera's frame (right, up, back).
constexpr Vec3f kKeyAt = {-0.45F, 0.62F, 0.64F};
constexpr Vec3f kFillAt = {0.78F, 0.05F, 0.62F};
constexpr float kShininess = 28;
constexpr float kGloss = 0.10F;

// Ambient rays end here, in parts of the mesh's extent: hollows are dark, yet the inside of a
// large cavity is not black.
constexpr float kAmbientReach = 0.35F;

Vec3f times(Vec3f a, Vec3f b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

std::byte srgb(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  const float y = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F;
  return static_cast<std::byte>(std::lround(255 * y));
}

// Of each vertex, the faces' normals weighted by area and so by their cross product.
std::vector<Vec3f> smooth_normals(const std::vector<Vec3f>& points,
                                  const std::vector<uint32_t>& abc) {
  std::vector<Vec3f> normals(points.size());
  for (size_t f = 0; f + 2 < abc.size(); f += 3) {
    const Vec3f a = points[abc[f]];
    const Vec3f n = cross(points[abc[f + 1]] - a, points[abc[f + 2]] - a);
    for (size_t k = 0; k < 3; ++k) normals[abc[f + k]] = normals[abc[f + k]] + n;
  }
  for (Vec3f& n : normals) n = normalised(n);
  return normals;
}

}  // namespace

size_t pixel_bytes(int width, int height) {
  return size_t{3} * static_cast<size_t>(width) * static_cast<size_t>(height);
}

Picture::Picture(int w, int h) : width(w), height(h), rgb(pixel_bytes(w, h)) {}

struct Renderer::Scene {
  std::vector<Vec3f> points;
  std::vector<Vec3f> normals;
  std::vector<uint32_t> abc;
  float extent = 0;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  explicit Scene(DrawnMesh mesh);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  Vec3f shade(const Camera& camera, Vec3f direction, uint32_t pixel, uint32_t sample,
              Vec3f background) const;
  void draw_row(const Camera& camera, Picture& picture, int left, int top, int size, int row) const;

 private:
  void build();
  bool blocked(Vec3f from, Vec3f direction, float reach) const;
  float ambient(Vec3f at, Vec3f normal, uint32_t pixel, uint32_t sample) const;
};

Renderer::Scene::Scene(DrawnMesh mesh) : points(std::move(mesh.points)), abc(std::move(mesh.abc)) {
  Vec3f low = {INFINITY, INFINITY, INFINITY};
  Vec3f high = {-INFINITY, -INFINITY, -INFINITY};
  for (const Vec3f p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  extent = std::sqrt(dot(high - low, high - low));
  normals = smooth_normals(points, abc);
  build();
}

void Renderer::Scene::build() {
  device = rtcNewDevice(nullptr);
  if (device == nullptr) throw Failure{"the ray tracer does not start on this machine"};
  scene = rtcNewScene(device);
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  // Embree reads whole vectors: its own buffers have the room for that.
  auto* xyz = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), points.size()));
  auto* faces = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), abc.size() / 3));
  if (xyz == nullptr || faces == nullptr) {
    rtcReleaseGeometry(geometry);
    throw Failure{"out of memory"};
  }
  std::copy(points.begin(), points.end(), xyz);
  std::copy(abc.begin(), abc.end(), faces);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) throw Failure{"the ray tracer has failed"};
}

Renderer::Scene::~Scene() {
  if (scene != nullptr) rtcReleaseScene(scene);
  if (device != nullptr) rtcReleaseDevice(device);
}

bool Renderer::Scene::blocked(Vec3f from, Vec3f direction, float reach) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{};
  ray.org_x = from.x;
  ray.org_y = from.y;
  ray.org_z = from.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tfar = reach;
  ray.mask = ~0U;
  rtcOccluded1(scene, &context, &ray);
  return ray.tfar < 0;
}

float Renderer::Scene::ambient(Vec3f at, Vec3f normal, uint32_t pixel, uint32_t sample) const {
  int open = 0;
  for (uint32_t k = 0; k < kAmbientRays; ++k) {
    const Vec3f d =
        cosine_direction(normal, pixel, sample * kAmbientRays + k, kGrid * kGrid * kAmbientRays);
    if (!blocked(at, d, kAmbientReach * extent)) ++open;
  }
  return static_cast<float>(open) / kAmbientRays;
}

Vec3f Renderer::Scene::shade(const Camera& camera, Vec3f direction, uint32_t pixel, uint32_t sample,
                             Vec3f background) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit hit{};
  hit.ray.org_x = camera.eye.x;
  hit.ray.org_y = camera.eye.y;
  hit.ray.org_z = camera.eye.z;
  hit.ray.dir_x = direction.x;
  hit.ray.dir_y = direction.y;
  hit.ray.dir_z = direction.z;
  hit.ray.tfar = std::numeric_limits<float>::infinity();
  hit.ray.mask = ~0U;
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &context, &hit);
  if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return background;

  const uint32_t* f = &abc[size_t{3} * hit.hit.primID];
  const float u = hit.hit.u;
  const float v = hit.hit.v;
  Vec3f flat = normalised({hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z});
  Vec3f n = normalised(normals[f[0]] * (1 - u - v) + normals[f[1]] * u + normals[f[2]] * v);
  if (dot(flat, direction) > 0) flat = flat * -1;
  if (dot(n, flat) < 0) n = n * -1;
  // Off the surface by more than the rounding of the hit.
  const Vec3f at = camera.eye + direction * hit.ray.tfar + flat * (2e-4F * extent);

  const auto to_world = [&](Vec3f d) {
    return normalised(camera.right * d.x + camera.up * d.y + camera.back * d.z);
  };
  const Vec3f key_at = to_world(kKeyAt);
  const Vec3f half = normalised(key_at - direction);
  const float key = std::max(0.0F, dot(n, key_at));
  const float fill = std::max(0.0F, dot(n, to_world(kFillAt)));
  const float open = ambient(at, n, pixel, sample);
  Vec3f light = kAmbient * open + kFill * (fill * (0.3F + 0.7F * open));
  Vec3f gloss;
  if (key > 0 && !blocked(at, key_at, std::numeric_limits<float>::infinity())) {
    light = light + kKey * key;
    gloss = kKey * (kGloss * std::pow(std::max(0.0F, dot(n, half)), kShininess));
  }
  return times(kBone, light) + gloss;
}

void Renderer::Scene::draw_row(const Camera& camera, Picture& picture, int left, int top, int size,
                               int row) const {
  const float height = static_cast<float>(row) / static_cast<float>(size);
  const Vec3f background = kTop * (1 - height) + kBottom * height;
  for (int column = 0; column < size; ++column) {
    const auto pixel = static_cast<uint32_t>(row * size + column);
    Vec3f sum;
    for (int s = 0; s < kGrid * kGrid; ++s) {
      const int part_of_row = s / kGrid;
      const float x = static_cast<float>(column) + (static_cast<float>(s % kGrid) + 0.5F) / kGrid;
      const float y = static_cast<float>(row) + (static_cast<float>(part_of_row) + 0.5F) / kGrid;
      const float scale = 2 / static_cast<float>(size);
      const Vec3f d = camera.direction(x * scale - 1, 1 - y * scale);
      sum = sum + shade(camera, d, pixel, static_cast<uint32_t>(s), background);
    }
    const Vec3f mean = sum * (1.0F / (kGrid * kGrid));
    std::byte* out = picture.rgb.data() +
                     3 * (static_cast<size_t>(top + row) * static_cast<size_t>(picture.width) +
                          static_cast<size_t>(left + column));
    out[0] = srgb(mean.x);
    out[1] = srgb(mean.y);
    out[2] = srgb(mean.z);
  }
}

Renderer::Renderer(const std::string& path, const TriangleMesh& mesh)
    : scene_(new Scene(drawn_mesh(path, mesh))) {}
Renderer::~Renderer() {
  delete scene_;
}

void Renderer::draw(const View& view, Picture& picture, int left, int top, int size) const {
  const Camera camera(view, scene_->points);
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int row = next++; row < size; row = next++) {
      scene_->draw_row(camera, picture, left, top, size, row);
    }
  };
  std::vector<std::jthread> helpers(std::max(1U, std::thread::hardware_concurrency()) - 1);
  for (auto& helper : helpers) helper = std::jthread(work);
  work();
}

}  // namespace plc::tools
