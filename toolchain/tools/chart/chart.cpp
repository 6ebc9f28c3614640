// Derives regions from rows, and the labels of programs, guards and events.
#include "toolchain/tools/chart/chart.hpp"

#include "toolchain/tools/chart/program_text.hpp"

#include <algorithm>

namespace tappet::chart {

Regions::Regions(const StateHierarchy& names) : region_of_(names.states()) {
    for (std::size_t i = 0; i < names.states(); ++i) {
        const StateRow& row = names.table.states[i];
        auto place = std::ranges::find_if(regions_, [&](const Region& each) {
            return each.parent == names.parent[i] && each.name == row.region;
        });
        if (place == regions_.end())
            place = regions_.insert(place, Region{names.parent[i], std::string{row.region}, {}, no_state});
        place->states.push_back(static_cast<StateIndex>(i));
        if (row.initial && place->initial == no_state) place->initial = static_cast<StateIndex>(i);
        region_of_[i] = static_cast<std::size_t>(place - regions_.begin());
    }
}

std::vector<std::size_t> Regions::inside(StateIndex composite) const {
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < regions_.size(); ++k)
        if (regions_[k].parent == composite) found.push_back(k);
    return found;
}

bool Regions::orthogonal() const {
    return std::ranges::any_of(regions_, [&](const Region& each) { return inside(each.parent).size() > 1; });
}

std::string program_label(const Chart& chart, ProgramRef program) {
    if (program.call != nullptr) return function_name(program.call);
    if (program.program == no_program || chart.programs == nullptr) return {};
    return ProgramText{chart}.program(program.program);
}

std::string guard_label(const Chart& chart, ConditionRef guard) {
    if (guard.call != nullptr) return function_name(guard.call);
    if (guard.condition == no_condition || chart.programs == nullptr) return {};
    return ProgramText{chart}.condition(guard.condition);
}

DataOffset captured_at(const Chart& chart, const CaptureRow& capture) {
    if (capture.count == 0) return capture.raw;
    return chart.programs->instructions[std::size_t{capture.first} + capture.count - 1].to;
}

std::string event_label(const Chart& chart, const TransitionRow& row) {
    std::string text{row.event};
    if (row.captures == 0 || chart.programs == nullptr) return text;
    text += "(";
    for (std::size_t c = 0; c < row.captures; ++c) {
        const CaptureRow& capture = chart.machine.captures[row.first_capture + c];
        text += (c == 0 ? "" : ", ") + ProgramText{chart}.variable(captured_at(chart, capture));
    }
    return text + ")";
}

} // namespace tappet::chart
