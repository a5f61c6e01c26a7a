#pragma once
#include <cstddef>

#include "idl/fields.hpp"
#include "tests/bus/messages_for_tests.hpp"

/// A message of each type of about the size that it has in a running scene of an organ with 640 surface nodes and two
/// tools. Keyframes are those of a small scene, since here they come a thousand times as often as otherwise.
namespace palpate::testing {

inline constexpr std::size_t kSurfaceNodes = 640;
inline constexpr std::size_t kKeyframeBytes = 4096;

template <class M>
M realistic() {
  if constexpr (std::same_as<M, ToolState>)
    return tool_sample();
  else if constexpr (std::same_as<M, DeviceState>)
    return device_sample();
  else if constexpr (std::same_as<M, ContactState>)
    return contact_sample(3);
  else if constexpr (std::same_as<M, ForceState>)
    return force_sample();
  else if constexpr (std::same_as<M, SurfaceState>)
    return surface_sample(kSurfaceNodes);
  else if constexpr (std::same_as<M, NodeStatus>)
    return status_sample("render 7@there");
  else if constexpr (std::same_as<M, ClockProbe>)
    return probe_sample();
  else if constexpr (std::same_as<M, ClockAnswer>)
    return answer_sample();
  else if constexpr (std::same_as<M, PictureState>)
    return picture_sample();
  else if constexpr (std::same_as<M, TopologyChange>)
    return topology_sample();
  else if constexpr (std::same_as<M, LocalContactModel>)
    return local_model_sample(3, 24);
  else if constexpr (std::same_as<M, DeformStep>)
    return deform_step_sample();
  else if constexpr (std::same_as<M, ModalState>)
    return modal_sample(48, 6);
  else if constexpr (std::same_as<M, CatheterState>)
    return catheter_sample(61);
  else if constexpr (std::same_as<M, TaskRecord>)
    return task_sample();
  else if constexpr (std::same_as<M, SceneText>) {
    SceneText m = scene_sample();
    m.text = std::string(1500, '#');
    return m;
  } else if constexpr (std::same_as<M, HapticKeyframe>) {
    HapticKeyframe m = keyframe_sample();
    m.state.resize(kKeyframeBytes, 7);
    return m;
  } else if constexpr (std::same_as<M, DeformKeyframe>) {
    DeformKeyframe m = deform_keyframe_sample();
    m.state.resize(kKeyframeBytes, 7);
    return m;
  } else if constexpr (std::same_as<M, HeldTopology>) {
    return held_topology_sample();
  } else {  // whatever comes: every number 1, every text a word
    M m;
    const auto fill = []<class T>(const char*, T& field) {
      if constexpr (std::is_arithmetic_v<T>)
        field = 1;
      else if constexpr (std::same_as<T, std::string>)
        field = "word";
    };
    fields(fill, m);
    return m;
  }
}

}  // namespace palpate::testing
