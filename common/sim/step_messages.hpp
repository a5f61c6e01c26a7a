#pragma once
#include <vector>

#include "common/sim/step_record.hpp"

namespace palpate {

/// Fills in what a task record says of the task.
void describe(const Task& task, TaskRecord& record);

/// What a finished step says of one tool, run and seq apart.
ToolState tool_state(const StepRecord& record, int tool);
ForceState force_state(const StepRecord& record, int tool);
/// Everything but run and seq; keeps the message's memory.
void describe_contacts(const StepRecord& record, int tool, ContactState& message);

/// One message for each body whose state the haptic node owns, with body and run filled in and room for the rest.
std::vector<ModalState> modal_states(const HapticStep& haptic, std::uint64_t run);
std::vector<CatheterState> catheter_states(const HapticStep& haptic, std::uint64_t run);
/// Fills those messages, in that order, from a record that has shapes; seq stays.
void describe_shapes(const StepRecord& record, std::vector<ModalState>& messages);
void describe_shapes(const StepRecord& record, std::vector<CatheterState>& messages);

}  // namespace palpate
