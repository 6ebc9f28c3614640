// Places a machine's map, with the places of all live values, at the beginning of the memory that other
// processes may map.
#include "kernel/base/version.hpp"
#include "kernel/machine/instance/builder.hpp"
#include "kernel/machine/map/types.hpp"
#include "kernel/os/box.hpp"
#include "kernel/os/local_socket.hpp"

#include <atomic>
#include <cstddef>
#include <cstring>
#include <new>
#include <string_view>

namespace tappet {

namespace {

/// Returns the records of one section, for completion.
template <class Record>
std::span<Record> records(std::span<std::byte> memory, const map::Section& section) noexcept {
    return {reinterpret_cast<Record*>(memory.data() + section.at), section.count};
}

static_assert(sizeof(map::Times) == sizeof(ReactionTimes) &&
              offsetof(map::Times, total_ns) == offsetof(ReactionTimes, total) &&
              offsetof(map::Times, longest_ns) == offsetof(ReactionTimes, longest) &&
              offsetof(map::Times, histogram) == offsetof(ReactionTimes, histogram));

} // namespace

std::expected<void, Sentence> MachineBuilder::share_memory() {
    if (machine_.map.empty() && !instance_.is_guarded_) return {};
    return instance_.observation().shared_.lay_under(machine_.memory.first(machine_.plan.shared_bytes),
                                                     "tappet-machine");
}

std::uint64_t MachineBuilder::offset_of(const void* place) const noexcept {
    const auto* byte = static_cast<const std::byte*>(place);
    const std::byte* begin = machine_.memory.data();
    const bool shared = place != nullptr && byte >= begin && byte < begin + machine_.plan.shared_bytes;
    return shared ? static_cast<std::uint64_t>(byte - begin) : 0;
}

void MachineBuilder::place_map() {
    if (machine_.map.empty()) return;
    const auto memory = machine_.memory;
    std::memcpy(memory.data(), machine_.map.data(), machine_.map.size());
    new (instance_.at<Observed>(machine_.plan.observed_at)) Observed;
    auto& header = *instance_.at<map::Header>(0);
    header.block_bytes = machine_.plan.shared_bytes;
    header.process = os::own_process();
    header.forced_at = machine_.plan.observed_at;
    header.scope_at = machine_.plan.scope_at;
    header.report_at = offset_of(instance_.observation().records_);
    const os::BuildId build = os::build_id();
    static_assert(sizeof build.digits < sizeof header.build_id);
    std::memcpy(header.build_id.data(), build.digits.data(), build.length);
    framework_version.copy(header.framework.data(), header.framework.size() - 1);
    const auto components = records<map::Component>(memory, header.components);
    const auto facets = records<map::Facet>(memory, header.facets);
    for (std::size_t c = 0; c < components.size(); ++c) {
        components[c].place_at = machine_.plan.component_at[c];
        for (std::size_t f = 0; f < components[c].facet_count; ++f)
            place_facet({c, f}, facets[components[c].first_facet + f]);
    }
    const auto activities = records<map::Activity>(memory, header.activities);
    for (std::size_t a = 0; a < activities.size(); ++a) {
        activities[a].generation_at = offset_of(instance_.engines()[a].generation_address());
        activities[a].now_at = offset_of(instance_.engines()[a].now_address());
    }
    for (map::Figure& figure : records<map::Figure>(memory, header.figures)) place_figure(figure);
    const auto connections = records<map::Connection>(memory, header.connections);
    for (std::size_t x = 0; x < connections.size(); ++x)
        connections[x].times_at = offset_of(instance_.observation().times_of_connection(x));
    const auto reactions = records<map::Reaction>(memory, header.reactions); // rows first, then triggers
    for (std::size_t i = 0; i < machine_.table.reactions.size(); ++i)
        reactions[i].times_at = offset_of(instance_.observation().times_of_reaction(i));
    place_fields(header);
    std::atomic_ref{header.ready}.store(1, std::memory_order_release);
}

void MachineBuilder::place_facet(End end, map::Facet& record) {
    const Facet& row = facet_at(machine_.table, end);
    if (row.port != nullptr) {
        const PortPlaces places = row.port->places(instance_.facet(end), row.kind == FacetKind::input);
        record.forced_at = offset_of(places.forced);
        record.forced_value_at = offset_of(places.forced_value);
        // An input that several components write in turns is shown at its writers: nobody outside knows which
        // of them it reads. A forced value is in the input itself.
        std::size_t writers = 0;
        if (machine_.table.extras->size() != 0 && row.kind == FacetKind::input)
            for (const Link& link : machine_.index.connections) writers += link.to == end ? 1u : 0u;
        if (writers > 1) return;
        record.value_at = offset_of(places.value);
        record.stamp_at = offset_of(places.stamp);
        record.writes_at = offset_of(places.writes);
    } else if (row.property != nullptr) {
        record.value_at = offset_of(instance_.facet(end));
    }
}

void MachineBuilder::place_figure(map::Figure& figure) {
    switch (figure.owner) {
    case map::Owner::machine: figure.value_at = machine_.plan.observed_at; break;
    case map::Owner::component: {
        const GatedComponent& gate = *instance_.gate_of(figure.index);
        const std::string_view wanted{instance_.at<const char>(figure.name.at), figure.name.length};
        figure.value_at = wanted == "state"     ? offset_of(&gate.state)
                          : wanted == "dropped" ? offset_of(&gate.dropped)
                                                : offset_of(&gate.dropped_writes);
        break;
    }
    case map::Owner::activity: {
        const std::string_view wanted{instance_.at<const char>(figure.name.at), figure.name.length};
        for (const map::EngineFigure& each : map::engine_figures)
            if (each.name == wanted)
                figure.value_at = offset_of(&instance_.engines()[figure.index].statistics()) + each.at;
        break;
    }
    case map::Owner::connection:
    case map::Owner::reaction: break;
    }
}

void MachineBuilder::place_fields(const map::Header& header) {
    const auto types = records<map::Type>(machine_.memory, header.types);
    const auto fields = records<map::Field>(machine_.memory, header.fields);
    for (std::size_t t = 0; t < types.size(); ++t) {
        const auto of_record = machine_.map_types[t]->fields;
        for (std::size_t f = 0; f < of_record.size(); ++f)
            fields[types[t].first_field + f].at = static_cast<std::uint32_t>(of_record[f].offset());
    }
}

} // namespace tappet
