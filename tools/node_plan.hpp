#pragma once
#include <string>
#include <vector>

#include "common/scene/scene.hpp"

namespace palpate {

/// What a command line asks of a run besides the scene's own sections.
struct RunWishes {
  bool log = false;      ///< a topic log, where the scene has no [record]
  bool picture = false;  ///< a film or a still
  bool browsers = false;
  int processes = 0;  ///< 0: those that somebody looks at; 3: a deformation node of its own in any case
};

/// The nodes of a scene on this machine besides the haptic node, which is always one of them.
struct NodePlan {
  bool recorder = false, deform = false, render = false, web = false;

  /// Whether the render node deforms too.
  bool superposes() const { return render && !deform; }
  /// As they are called in words, in the order in which they start: "recorder", "deform_node", "render_node" or
  /// "render_node --deform", "web_node", "haptic_node".
  std::vector<std::string> names() const;
};

/// What `palpate run` starts, and `palpate check` tells.
NodePlan plan_nodes(const Scene& scene, const RunWishes& wishes);

}  // namespace palpate
