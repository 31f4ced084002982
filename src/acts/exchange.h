#pragma once
// Instruments that share a port.
//
// One of them is in it, the others wait outside. Who has drawn the one that is there back into the port may have
// another one come in: it comes closed and not turned, along the same way, as deep as the other one was. That takes the
// assistant some seconds, which are the operator's to wait; here it happens between two steps.

#include "field/field.h"

namespace calot {

/// m that an instrument is in at the start, and at most when it is exchanged: in its trocar, out of the field.
inline constexpr double port_depth = 30e-3;

/// Whether it is no further in than that: what its jaws do there is no act.
bool is_in_trocar(const Tool& tool);

/// The tool that is in the port of one that waits: there always is one.
ToolIndex tool_in_port(const std::vector<Tool>& tools, const Tool& waiting);

/// Fails (scenario) where a tool that waits is to act otherwise than to come in, or to be elsewhere by more than
/// rounding.
std::optional<Failure> check_waiting(const std::vector<Tool>& tools, const StepInput& input);

/// Brings in each tool whose action `exchange` begins (`actions`: one a tool, or none). Adds the events exchange and
/// blocked_exchange: where the one that is there is further in than port_depth or holds something, be it by friction alone,
/// where no other one is there, or where what comes in would touch an organ, tissue or another instrument. What was drawn
/// out waits clean: of its jaws it knows nothing any more.
void exchange_tools(Field& field, const std::vector<InstrumentAction>& actions,
                    std::vector<WorldEvent>& events);

}  // namespace calot
