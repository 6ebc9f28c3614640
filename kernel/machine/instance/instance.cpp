// Configures a machine, requests its stop, and saves its properties.
#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/instance/builder.hpp"

#include <algorithm>

namespace tappet {

std::expected<Standing, Sentence> MachineInstance::configure(std::span<const ProvidedDevice> devices) {
    TAPPET_CONTRACT(!is_configured_ || life_.stands(), Contract::engine_runs, no_activity);
    is_configured_ = true;
    if (const auto built = MachineBuilder{*this, store_}.build(devices); !built)
        return std::unexpected(built.error());
    return Standing{};
}

void MachineInstance::ask_stop(StopReason reason, std::uint64_t detail, const Engine* from) noexcept
    TAPPET_REALTIME {
    int free = 0;
    if (!stop_->asked.compare_exchange_strong(free, 1, std::memory_order_acq_rel)) return;
    stop_->request = {reason, detail, from};
    stop_->at = clock().now();
    stop_->asked.store(2, std::memory_order_release);
    supervisor_.wake();
}

Sentence MachineInstance::describe_stop() const {
    const StopRequest& stop = stop_request();
    const std::string_view who = stop.from == nullptr ? std::string_view{} : stop.from->name();
    switch (stop.reason) {
    case StopReason::none: return Sentence{"no stop was requested"};
    case StopReason::requested: return Sentence{"requested from outside"};
    case StopReason::broken_contract: return Sentence{"a contract was broken in activity \"", who, "\""};
    case StopReason::behaviour: {
        const std::string_view driven = machine().table.components[stop.detail].name;
        Sentence text{"the behaviour of \"", driven, "\" in activity \"", who, "\" is in error: "};
        if (const BehaviourUnit* unit = behaviour_of(driven);
            unit != nullptr && unit->failed_part() != nullptr)
            return text.add(unit->describe_fault());
        const BehaviourSlot* slot = slot_of(driven);
        return slot != nullptr && slot->active() != nullptr ? text.add(slot->active()->describe_fault())
                                                            : text;
    }
    case StopReason::missed_deadline: {
        const auto function = static_cast<std::uint32_t>(stop.detail);
        if (function == Miss::nobody || stop.from == nullptr)
            return Sentence{"activity \"", who, "\" missed its deadline: it began late"};
        return Sentence{"activity \"", who, "\" missed its deadline: component \"",
                        stop.from->plan().parts[function / functions_per_part].name, "\" took the time"};
    }
    case StopReason::stale_input: {
        const ConnectionRow& row = machine().table.connections[stop.detail];
        return Sentence{"connection \"",
                        row.from,
                        "\" -> \"",
                        row.to,
                        "\" is stale: nothing came for more than ",
                        row.max_age.count() / 1000,
                        " us"};
    }
    case StopReason::activity_hangs:
        return Sentence{"activity \"", who, "\" neither starts nor stops: its thread hangs"};
    case StopReason::not_started: return Sentence{"activity \"", who, "\" could not be started"};
    case StopReason::section:
        return machine().table.extras->at(stop.detail >> 32)->describe_stop(stop.detail & 0xFFFFFFFF);
    }
    return {};
}

Sentence MachineInstance::save_properties(std::optional<Standing> standing) {
    const auto in_a_file = [](const ComponentRow& row) { return row.has_properties_file; };
    if (std::ranges::none_of(machine().table.components, in_a_file)) return {};
    if (!standing)
        return Sentence{"the properties are not saved: a thread that hangs may still change them; the files "
                        "are as they were"};
    Sentence first;
    for (std::size_t c = 0; c < machine().table.components.size(); ++c) {
        const ComponentRow& row = machine().table.components[c];
        if (!row.has_properties_file || store_.save == nullptr) continue;
        PropertyTransaction all;
        all.begin(row.name, *row.type, component(c));
        all.change_all();
        all.capture();
        const Sentence fault = store_.save(store_.self, row, all);
        if (first.empty()) first = fault;
    }
    return first;
}

} // namespace tappet
