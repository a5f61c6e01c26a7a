#pragma once
#include <string_view>

#include "common/models/kind.hpp"
#include "common/shell/spec.hpp"

namespace palpate {

/// A thin wall of shell elements, such as a duct, that moves by its lowest modes of vibration (BHS01 sec. V-C-1).
struct ModalShellSpec : ShellSpec {
  static constexpr std::string_view kKind = "modal_shell";
};

inline void describe(Description& d, ModalShellSpec& b) {
  describe(d, static_cast<ShellSpec&>(b));
}

ArchiveJob archive_job(const ModalShellSpec& body, const Progress& progress);
std::vector<std::string> archive_lines(const ModalShellSpec& body, const Archive& archive);

std::unique_ptr<BodyPart> make_haptic_part(const ModalShellSpec& body, const Archive& archive,
                                           const StepSettings& settings);

std::unique_ptr<BodyShape> make_shape(const ModalShellSpec& body, const Archive& archive, const StepSettings& settings);

void check(const ModalShellSpec& body, const CheckSettings& settings, CheckReport& report);

DirectProblem direct_problem(const ModalShellSpec& body);
FreeVibration vibration(const ModalShellSpec& body);

}  // namespace palpate
