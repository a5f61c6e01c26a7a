#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/scene/scene.hpp"
#include "tools/study/result.hpp"

namespace palpate::study {

/// One setting of one knob.
struct Point {
  std::string method, knob, value;
  std::function<void(Scene&)> apply;  ///< makes the scene run so; empty: no scene can say it
  bool serves = true;                 ///< can do all that the scene asks of the body, so that a budget may choose it
};

/// One way to move a body, with its knobs and its references.
class Method {
 public:
  virtual ~Method() = default;
  virtual int body() const = 0;  ///< position in the scene's list
  virtual std::vector<Point> points() const = 0;
  /// Cost and errors of one of points(). Throws std::runtime_error where the setting is refused.
  virtual Result evaluate(const Point& point) = 0;
};

using Methods = std::vector<std::unique_ptr<Method>>;

}  // namespace palpate::study
