// Holds the tables of a machine's acceptance on the heap.
#include "kernel/machine/accept.hpp"

#include "kernel/machine/check/check.hpp"
#include "kernel/machine/map/map.hpp"
#include "kernel/machine/plan/plan.hpp"
#include "kernel/os/shared_memory.hpp"

#include <cstdio>
#include <cstdlib>
#include <memory_resource>

namespace tappet {

struct Accepted::Tables {
    Tables(const MachineView& m, const Board& board, const Binding& binding);
    Tables(const Tables&) = delete;
    Tables& operator=(const Tables&) = delete;
    ~Tables() { os::unmap(machine.memory); }

    template <class Row>
    std::span<Row> take(std::size_t count) {
        static_assert(std::is_trivially_destructible_v<Row>);
        auto* const rows = static_cast<Row*>(arena.allocate(count * sizeof(Row), alignof(Row)));
        std::uninitialized_value_construct_n(rows, count);
        return {rows, count};
    }
    template <class... Rows>
    void take(std::size_t count, std::span<Rows>&... tables) {
        ((tables = take<Rows>(count)), ...);
    }
    void take_index(const MachineView& m, TableIndexView& index);
    void take_plan(const MachineView& m, PlanView& plan);
    std::size_t draw_map();

    std::pmr::monotonic_buffer_resource arena;
    Sentence refusal;
    AcceptedMachine machine;
};

void Accepted::Tables::take_index(const MachineView& m, TableIndexView& index) {
    take(m.components.size(), index.by_name, index.activity, index.position, index.in_order, index.waits_for,
         index.connections_into.first, index.connections_from.first, index.reactions_into.first, index.reach,
         index.acts);
    take(m.activities.size(), index.rank, index.by_rank, index.worst_response_ns);
    take(m.connections.size(), index.connections, index.connections_into.next, index.connections_from.next);
    take(m.reactions.size(), index.reactions, index.reactions_into.next);
}

void Accepted::Tables::take_plan(const MachineView& m, PlanView& plan) {
    const std::size_t a = m.activities.size();
    take(m.components.size(), plan.component_at, plan.part_of);
    take(a, plan.activities, plan.requests, plan.command_requests);
    take(a * a, plan.mail, plan.command_mail);
    take(m.connections.size(), plan.connections);
    take(m.behaviours.size(), plan.behaviours);
    take(count_subscriptions(m), plan.subscriptions, plan.subscription_at);
}

std::size_t Accepted::Tables::draw_map() {
    const auto& [table, board, binding, index, plan, memory, drawn, types] = machine;
    if (find_observer(table) == nowhere) return 0;
    const map::Counts counts = map::count(table, *board, *binding, index);
    const map::Header header = map::outline(counts);
    auto* const at = static_cast<std::byte*>(arena.allocate(header.map_bytes, alignof(std::max_align_t)));
    auto& placed = *std::construct_at(reinterpret_cast<map::Header*>(at), header);
    const auto section = [&]<class Record>(const map::Section& of, Record, std::size_t room) {
        auto* const records = reinterpret_cast<Record*>(at + of.at);
        std::uninitialized_value_construct_n(records, room);
        return std::span{records, room};
    };
    const auto type_ids = take<TypeId>(map::room(counts.types));
    map::draw(placed,
              {section(header.components, map::Component{}, map::room(counts.components)),
               section(header.facets, map::Facet{}, map::room(counts.facets)),
               section(header.activities, map::Activity{}, map::room(counts.activities)),
               section(header.connections, map::Connection{}, map::room(counts.connections)),
               section(header.reactions, map::Reaction{}, map::room(counts.reactions)),
               section(header.behaviours, map::Behaviour{}, map::room(counts.behaviours)),
               section(header.types, map::Type{}, map::room(counts.types)),
               section(header.fields, map::Field{}, map::room(counts.fields)),
               section(header.enumerators, map::Enumerator{}, map::room(counts.enumerators)),
               section(header.figures, map::Figure{}, map::room(counts.figures)),
               section(header.texts, char{}, map::room_of_texts(counts.characters)), type_ids,
               header.texts.at},
              table, *board, *binding, index);
    machine.map = {at, header.map_bytes};
    machine.map_types = type_ids.first(counts.types);
    return header.map_bytes;
}

Accepted::Tables::Tables(const MachineView& m, const Board& board, const Binding& binding)
    : machine{.table = m, .board = &board, .binding = &binding, .index = {}, .plan = {}, .memory = {}} {
    take_index(m, machine.index);
    refusal = check(m, board, binding, machine.index);
    if (!refusal.empty()) return;
    take_plan(m, machine.plan);
    make_plan(m, board, binding, machine.index, draw_map(), machine.plan);
    refusal = check_plan(m, board, machine.plan.subscriptions, machine.plan.bytes, machine.plan.stack_bytes);
    if (!refusal.empty()) return;
    // Pages of its own: a machine that others see maps shared memory over them.
    machine.memory = os::map_pages(machine.plan.bytes);
    if (machine.memory.empty())
        refusal = Sentence{m.name, ": there is no memory for its ", machine.plan.bytes,
                           " bytes; end other programs"};
}

Accepted::Accepted(const MachineView& table, const Board& board, const Binding& binding)
    : tables_{std::make_unique<Tables>(table, board, binding)} {}
Accepted::Accepted(Accepted&&) noexcept = default;
Accepted& Accepted::operator=(Accepted&&) noexcept = default;
Accepted::~Accepted() = default;

const Sentence& Accepted::refusal() const noexcept { return tables_->refusal; }

AcceptedMachine Accepted::machine() {
    if (refusal().empty()) return tables_->machine;
    std::fprintf(stderr, "%.*s\n", static_cast<int>(refusal().size()), refusal().view().data());
    std::abort();
}

} // namespace tappet
