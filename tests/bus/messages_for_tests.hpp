#pragma once
#include "idl/messages.hpp"

/// Messages in which every field differs from its default and from its neighbours.
namespace palpate::testing {

inline ToolState tool_sample(std::uint64_t seq = 7, std::uint32_t tool = 3) {
  return {tool, 11, seq, 12, 13, 14, 0.1, -0.2, 0.3, -0.4, 0.5, 0.6, 1, 1, 1, 15, 16, 17};
}

inline ContactState contact_sample(int contacts = 2) {
  ContactState m;
  m.tool = 1, m.run = 2, m.seq = 3, m.step = 4, m.sense_ns = 5;
  m.press = {0, 0.6, -0.8}, m.publish_ns = 6;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(contacts); ++i) {
    m.forces.push_back({i, 10 + i, {1.5 * i, -2.5, 3.25}});
    m.contacts.push_back(
        {i, {i, i + 1, i + 2}, {0.2, 0.3, 0.5}, {1e-3, 2e-3, 3e-3 * i}, {0, 0, 1}, {4, 5, 6}, i, i % 2});
  }
  return m;
}

inline SurfaceState surface_sample(std::size_t nodes, std::uint64_t seq = 1) {
  SurfaceState m;
  m.body = 0, m.run = 21, m.seq = seq, m.step = 22, m.sense_ns = 23, m.tissue_ns = 24, m.late_ns = 25,
  m.origin = {27, 28, 29.5}, m.publish_ns = 26;
  for (std::size_t i = 0; i < 3 * nodes; ++i) {
    m.position.push_back(0.001f * static_cast<float>(i % 977));
    m.normal.push_back(i % 3 == 2 ? 1.f : 0.f);
  }
  return m;
}

inline NodeStatus status_sample(const std::string& node = "haptic 4711@host") {
  NodeStatus m;
  m.node = node, m.role = "haptic", m.run = 1, m.seq = 2, m.stamp_ns = 3;
  m.scene_hash = "abc", m.archive_hash = "def", m.version = "0.1.0 avx2";
  m.rate_hz = 999.5, m.ticks = 1000, m.missed = 2, m.latency_p50_us = 12.5, m.latency_p99_us = 40;
  m.clock_of = "haptic 1@other", m.clock_offset_ns = -5, m.clock_uncertainty_ns = 6, m.clock_drift_ppm = -12.5;
  m.text = "Größe, \"quoted\"\nand a second line";
  return m;
}

inline HapticKeyframe keyframe_sample() {
  return {1, 2, 3, 0.001, "avx2 0.1.0", {0, 1, 2, 254, 255}, 4};
}

inline SceneText scene_sample() {
  return {9, 1, "hash", "title = \"liver\"\n", "avx2", 2};
}

inline ForceState force_sample() {
  return {2, 3, 4, 5, 6, {0.5, -1, 2}, {0.01, 0.02, -0.03}, 0.1, 0.2, 0.3, 0.4, 0.04, {7, -8, 9}, 0.25, 5, 7};
}

inline ClockProbe probe_sample() {
  return {"render 7@there", 2, 3};
}

inline ClockAnswer answer_sample() {
  return {"render 7@there", "haptic 4711@host", "a-b-c", 2, 3, 4, 5};
}

inline PictureState picture_sample() {
  return {"render 7@there", 2, 3, 4, 5, 6};
}

inline DeviceState device_sample() {
  return {1, 2, 3, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 4};
}

inline TopologyChange topology_sample(std::uint64_t seq = 3) {
  return {1, 2, seq, fell_away, 6, 7, {17, 5, 4000001}, 5};
}

inline HeldTopology held_topology_sample(std::uint32_t body = 1) {
  return {"render 7@there", body, 2, 3, {17, 5, 4000001}, 6};
}

inline LocalContactModel local_model_sample(std::uint32_t contacts = 2, std::uint32_t triangles = 3) {
  LocalContactModel m;
  m.tool = 1, m.run = 2, m.seq = 3, m.tool_run = 5, m.tool_step = 6, m.sense_ns = 7, m.publish_ns = 8;
  m.tissue_ns = 9, m.late_ns = 10;
  m.yaw = 0.1, m.pitch = 0.2, m.depth = 0.3, m.roll = 0.4, m.grip = 0.5;
  for (std::uint32_t i = 0; i < contacts; ++i)
    m.contacts.push_back(
        {i, i % 2, {0.1 * i, 0.2, 0.3}, {0, 0.6, -0.8}, {1, 2, 3.5}, {100, 1, 2, 3, 200, 4, 5, 6, 300.5 + i}});
  for (std::uint32_t i = 0; triangles > 0 && i < triangles + 2; ++i)
    m.nodes.push_back(
        {i, 7 + i, {0.01 * i, -0.02, 0.03}, {1e-3, 2e-3, -3e-3 * i}, {10, 1, 2, 1, 20, 3, 2, 3, 30.5 + i}});
  for (std::uint32_t i = 0; i < triangles; ++i) m.triangles.push_back({i, i + 1, i + 2});
  return m;
}

inline DeformStep deform_step_sample() {
  return {1, 2, 3, 11, 12, {{4, 5, 6}, {7, 8, 9}}, 0xFEDCBA9876543210, 10};
}

inline DeformKeyframe deform_keyframe_sample() {
  return {1, 2, 3, 5, 6, "avx2 0.1.0", {0, 1, 2, 254, 255}, 4};
}

inline ModalState modal_sample(std::uint32_t modes = 4, std::uint32_t forces = 3) {
  ModalState m;
  m.body = 1, m.run = 2, m.seq = 3, m.step = 4, m.sense_ns = 5, m.publish_ns = 6;
  for (std::uint32_t i = 0; i < modes; ++i) m.coordinates.push_back(1e-4 * i - 0.5);
  for (std::uint32_t i = 0; i < forces; ++i) m.forces.push_back({10 + i, {0.5f * static_cast<float>(i), -2.5f, 3.25f}});
  return m;
}

inline CreepState creep_sample(std::uint32_t loads = 3) {
  CreepState m;
  m.body = 1, m.run = 2, m.seq = 3, m.step = 4, m.sense_ns = 5, m.publish_ns = 6;
  for (std::uint32_t i = 0; i < loads; ++i) m.loads.push_back({10 + i, {0.5f * static_cast<float>(i), -2.5f, 3.25f}});
  return m;
}

inline CatheterState catheter_sample(int particles = 5) {
  CatheterState m;
  m.body = 1, m.run = 2, m.seq = 3, m.step = 4, m.sense_ns = 5, m.publish_ns = 6;
  for (int i = 0; i < 3 * particles; ++i) m.position.push_back(0.001 * i + 0.1);
  return m;
}

inline TaskRecord task_sample() {
  return {1, 2, 3, 4, 5, 0.01, 0.02, 3.5, 0.25, 6, 7, 8, 9.5, 10};
}

/// Calls f with one of every message or more.
template <class F>
void for_each_message(F&& f) {
  f(tool_sample());
  f(device_sample());
  f(contact_sample(3));
  f(contact_sample(0));
  f(force_sample());
  f(surface_sample(5));
  f(status_sample());
  f(keyframe_sample());
  f(scene_sample());
  f(topology_sample());
  f(held_topology_sample());
  f(local_model_sample());
  f(local_model_sample(0, 0));
  f(deform_step_sample());
  f(deform_keyframe_sample());
  f(modal_sample());
  f(modal_sample(0, 0));
  f(creep_sample());
  f(creep_sample(0));
  f(catheter_sample());
  f(task_sample());
  f(probe_sample());
  f(answer_sample());
  f(picture_sample());
}

}  // namespace palpate::testing
