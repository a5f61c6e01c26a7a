#pragma once
#include <vector>

#include "common/sim/step_record.hpp"

namespace palpate {

/// What a finished step says of one tool, run and seq apart.
ToolState tool_state(const StepRecord& record, int tool);
ForceState force_state(const StepRecord& record, int tool);
/// Everything but run and seq; keeps the message's memory.
void describe_contacts(const StepRecord& record, int tool, ContactState& message);

/// How the tasks of a scene stand after the last step, one a body that has one; run, seq, step and time apart.
std::vector<TaskRecord> task_records(const HapticStep& haptic);

}  // namespace palpate
