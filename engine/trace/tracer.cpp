// Faces to an Embree scene, packets of sixteen rays to hits.
//
// Wald, Woop, Benthin, Johnson, Ernst: Embree: A Kernel Framework for Efficient CPU Ray Tracing, 2014.
#include "engine/trace/tracer.h"

#include "engine/base/parallel.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstddef>
#include <stdexcept>
#include <string>

namespace patchlight {

// Triangles and quads are two geometries: a triangle passed off as a quad would be tested twice.
struct TracerState {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<uint32_t> face_of[2];  // geometry -> primitive -> face
  std::vector<Vec3> normal;          // a row a face
  std::vector<uint32_t> twin;        // a row a face
  std::string error;
  RayObserver* observer = nullptr;
};

namespace {

static_assert(sizeof(RayPacket) == sizeof(RTCRay16));
static_assert(offsetof(RayPacket, origin_x) == offsetof(RTCRay16, org_x));
static_assert(offsetof(RayPacket, near_distance) == offsetof(RTCRay16, tnear));
static_assert(offsetof(RayPacket, direction_x) == offsetof(RTCRay16, dir_x));
static_assert(offsetof(RayPacket, far_distance) == offsetof(RTCRay16, tfar));
static_assert(offsetof(RayPacket, mask) == offsetof(RTCRay16, mask));
// The last column is no part of older versions.
static_assert(sizeof(HitPacket) == sizeof(RTCRayHit16) ||
              sizeof(HitPacket) - sizeof(HitPacket::instance_primitive) == sizeof(RTCRayHit16));
static_assert(offsetof(HitPacket, u) == offsetof(RTCRayHit16, hit.u));
static_assert(offsetof(HitPacket, face) == offsetof(RTCRayHit16, hit.primID));
static_assert(offsetof(HitPacket, geometry) == offsetof(RTCRayHit16, hit.geomID));
static_assert(offsetof(HitPacket, instance) == offsetof(RTCRayHit16, hit.instID));

void keep_error(void* pointer, RTCError, const char* text) {
  auto* state = static_cast<TracerState*>(pointer);
  if (state->error.empty()) state->error = text ? text : "unknown error";
}

void free_state(TracerState* state) {
  if (state->scene) rtcReleaseScene(state->scene);
  if (state->device) rtcReleaseDevice(state->device);
  delete state;
}

void expand_mask(uint32_t active, int (&valid)[16]) {
  for (uint32_t k = 0; k < 16; ++k) valid[k] = (active >> k & 1u) ? -1 : 0;
}

// Of two faces back to back only the first is given to Embree; find_hits tells them apart by the ray's side.
bool is_traced(const FaceTable& faces, size_t f) { return faces.twin[f] == kNone || faces.twin[f] > f; }

void add_geometry(TracerState& state, const FaceTable& faces, RTCGeometryType type, uint32_t corner_count) {
  auto& face_of = state.face_of[corner_count == 4 ? 1 : 0];
  for (size_t f = 0; f < faces.size(); ++f)
    if (faces.corner_count[f] == corner_count && is_traced(faces, f))
      face_of.push_back(static_cast<uint32_t>(f));
  RTCGeometry geometry = rtcNewGeometry(state.device, type);
  if (!face_of.empty()) {
    auto* vertex =
        static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                    3 * sizeof(float), face_of.size() * corner_count));
    auto* index = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, corner_count == 4 ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3,
        corner_count * sizeof(uint32_t), face_of.size()));
    if (!vertex || !index) throw std::bad_alloc{};
    for (size_t k = 0; k < face_of.size() * corner_count; ++k) {
      const Vec3 p = faces.corners[face_of[k / corner_count]][k % corner_count];
      vertex[3 * k] = p.x, vertex[3 * k + 1] = p.y, vertex[3 * k + 2] = p.z;
      index[k] = static_cast<uint32_t>(k);
    }
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(state.scene, geometry, corner_count == 4 ? 1 : 0);
  rtcReleaseGeometry(geometry);
}

#if defined(RTC_VERSION_MAJOR) && RTC_VERSION_MAJOR >= 4
RTCRayQueryFlags find_flags(RayOrder order) {
  return order == RayOrder::kCoherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
}
#else
RTCIntersectContext make_context(RayOrder order) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = order == RayOrder::kCoherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                               : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}
#endif

}  // namespace

Tracer make_tracer(const FaceTable& faces) {
  Tracer tracer{{new TracerState, free_state}};
  TracerState& state = *tracer.state;
  state.device = rtcNewDevice(nullptr);
  if (!state.device) throw std::runtime_error("Embree could not make a device");
  rtcSetDeviceErrorFunction(state.device, keep_error, &state);
  state.normal = faces.normal;
  state.twin = faces.twin;
  state.scene = rtcNewScene(state.device);
  // Without ROBUST, rays slip through shared edges and closed rooms leak (Embree issue 538).
  rtcSetSceneFlags(state.scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(state.scene, RTC_BUILD_QUALITY_HIGH);
  add_geometry(state, faces, RTC_GEOMETRY_TYPE_TRIANGLE, 3);
  add_geometry(state, faces, RTC_GEOMETRY_TYPE_QUAD, 4);
  run_on_workers([&] { rtcCommitScene(state.scene); });
  if (!state.error.empty()) throw std::runtime_error("Embree: " + state.error);
  return tracer;
}

// The only lines in which Embree's versions differ, with those above.
#if defined(RTC_VERSION_MAJOR) && RTC_VERSION_MAJOR >= 4
void trace_nearest(const Tracer& tracer, const int* valid, HitPacket& packet, RayOrder order) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = find_flags(order);
  rtcIntersect16(valid, tracer.state->scene, reinterpret_cast<RTCRayHit16*>(&packet), &arguments);
}
void trace_blocked(const Tracer& tracer, const int* valid, RayPacket& packet, RayOrder order) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = find_flags(order);
  rtcOccluded16(valid, tracer.state->scene, reinterpret_cast<RTCRay16*>(&packet), &arguments);
}
#else
void trace_nearest(const Tracer& tracer, const int* valid, HitPacket& packet, RayOrder order) {
  RTCIntersectContext context = make_context(order);
  rtcIntersect16(valid, tracer.state->scene, &context, reinterpret_cast<RTCRayHit16*>(&packet));
}
void trace_blocked(const Tracer& tracer, const int* valid, RayPacket& packet, RayOrder order) {
  RTCIntersectContext context = make_context(order);
  rtcOccluded16(valid, tracer.state->scene, &context, reinterpret_cast<RTCRay16*>(&packet));
}
#endif

void find_hits(const Tracer& tracer, HitPacket& packet, uint32_t active) {
  if (tracer.state->observer) tracer.state->observer->see_nearest(packet.ray, active);
  alignas(64) int valid[16];
  expand_mask(active, valid);
  for (uint32_t k = 0; k < 16; ++k) {
    packet.ray.time[k] = 0, packet.ray.mask[k] = ~0u, packet.ray.id[k] = k, packet.ray.flags[k] = 0;
    packet.geometry[k] = packet.face[k] = RTC_INVALID_GEOMETRY_ID;
    packet.instance[k] = packet.instance_primitive[k] = RTC_INVALID_GEOMETRY_ID;
  }
  trace_nearest(tracer, valid, packet, RayOrder::kCoherent);
  for (uint32_t k = 0; k < 16; ++k) {
    if (packet.geometry[k] == RTC_INVALID_GEOMETRY_ID || !valid[k]) {
      packet.face[k] = kNone;
      continue;
    }
    const uint32_t face = tracer.state->face_of[packet.geometry[k]][packet.face[k]];
    const Vec3 direction(packet.ray.direction_x[k], packet.ray.direction_y[k], packet.ray.direction_z[k]);
    const uint32_t twin = tracer.state->twin[face];
    packet.face[k] = twin != kNone && dot(direction, tracer.state->normal[face]) > 0 ? twin : face;
  }
}

uint32_t find_blocked(const Tracer& tracer, RayPacket& packet, uint32_t active, RayOrder order) {
  if (tracer.state->observer) tracer.state->observer->see_visibility(packet, active);
  alignas(64) int valid[16];
  expand_mask(active, valid);
  for (uint32_t k = 0; k < 16; ++k)
    packet.time[k] = 0, packet.mask[k] = ~0u, packet.id[k] = k, packet.flags[k] = 0;
  trace_blocked(tracer, valid, packet, order);
  uint32_t blocked = 0;
  for (uint32_t k = 16; k-- > 0;) blocked = 2 * blocked + (packet.far_distance[k] < 0 ? 1 : 0);
  return blocked & active;
}

void observe_rays(const Tracer& tracer, RayObserver* observer) { tracer.state->observer = observer; }

const char* tracer_version() { return "Embree " RTC_VERSION_STRING; }

}  // namespace patchlight
