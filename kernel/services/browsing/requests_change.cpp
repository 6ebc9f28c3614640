// Requests that change something: prepared here, carried out by the engine that owns the data, answered when
// done.
#include "kernel/services/browsing/browser_service.hpp"

#include "kernel/machine/instance/instance.hpp"
#include "kernel/services/browsing/names.hpp"

namespace tappet {

using browsing::FacetCall;

namespace {

FacetCall& call_of(void* self) noexcept TAPPET_REALTIME { return *static_cast<FacetCall*>(self); }

bool is_input(const Facet& facet) noexcept TAPPET_REALTIME { return facet.kind == FacetKind::input; }

bool is_forced(const FacetCall& call) noexcept TAPPET_REALTIME {
    return *call.facet->port->places(call.place, is_input(*call.facet)).forced;
}

// A value that a component reads has changed: the component reads it in its next step, which must come by
// itself.
void step_again(const FacetCall& call) noexcept TAPPET_REALTIME {
    Engine& engine = call.machine->engines()[call.machine->machine().index.activity[call.end.component]];
    if (!engine.plan().periodic) engine.waiter().wake();
}

// The values that a component left when it stopped are its safe values: they are not forced. An input may be
// forced before its component runs: the component may be waiting for that value.
void force_port(void* self, const std::byte*) noexcept TAPPET_REALTIME {
    FacetCall& call = call_of(self);
    const GatedComponent& gate = *call.machine->gate_of(call.end.component);
    const bool waits = gate.state.load(std::memory_order_acquire) == ComponentState::waiting;
    call.refused =
        is_input(*call.facet) ? !waits && !gate.admits(Entry::at_once) : !gate.admits(Entry::queued);
    if (call.refused) return;
    // This read ends the value of a stopped writer.
    const bool is_unwritten = call.drives && call.facet->port->flow(call.place) == Flow::never_written;
    const bool was_forced = is_forced(call);
    call.never_written =
        is_unwritten || !call.facet->port->force(call.place, is_input(*call.facet), call.value.data());
    // The count is for observers: no decision uses it, so its sum is not used here.
    if (!was_forced && !call.never_written)
        call.machine->observation().forced_ports().fetch_add(1, std::memory_order_relaxed);
    step_again(call);
}

void release_port(void* self, const std::byte*) noexcept TAPPET_REALTIME {
    const FacetCall& call = call_of(self);
    if (is_forced(call)) call.machine->observation().forced_ports().fetch_sub(1, std::memory_order_relaxed);
    call.facet->port->release(call.place, is_input(*call.facet));
    step_again(call);
}

void run_operation(void* self, const std::byte*) noexcept TAPPET_REALTIME {
    FacetCall& call = call_of(self);
    call.refused = !call.facet->operation->run(*call.machine->gate_of(call.end.component), Entry::queued,
                                               call.value.data());
}

void run_method(void* self, const std::byte*) noexcept TAPPET_REALTIME {
    FacetCall& call = call_of(self);
    call.refused =
        !call.facet->method->call_packed(*call.machine->gate_of(call.end.component), Entry::queued,
                                         call.value.data(), call.value.data() + call.facet->type->size);
}

/// Only data ports can be forced: a buffered port has no single value.
Sentence find_port(const MachineView& table, std::string_view name, End& end) noexcept {
    if (Sentence fault = browsing::find_facet(table, name, {}, end); !fault.empty()) return fault;
    const FacetKind kind = facet_at(table, end).kind;
    if (kind == FacetKind::input || kind == FacetKind::output) return {};
    if (kind == FacetKind::buffer_input || kind == FacetKind::buffer_output)
        return Sentence{
            "\"", name,
            "\" is a buffered port: every value of it counts, so none can stand for all; force a data "
            "port in front of it or behind it"};
    return browsing::find_facet(table, name, {FacetKind::input, FacetKind::output}, end);
}

} // namespace

BrowserService::Verdict BrowserService::check_alive(std::size_t component) noexcept {
    const AcceptedMachine& machine = machine_->machine();
    const std::size_t activity = machine.index.activity[component];
    if (is_alive(*machine_, activity)) return {};
    return {Refusal::not_now, Sentence{"activity \"", machine.table.activities[activity].name,
                                       "\" is stopped, and nothing of it can be changed; start it first"}};
}

FacetCall& BrowserService::prepare(Pending& place, End end) const noexcept {
    auto& of = std::get<FacetCall>(place.work);
    of.machine = machine_;
    of.end = end;
    of.facet = &facet_at(machine_->machine().table, end);
    of.place = of.facet->port != nullptr ? machine_->place_of(end) : machine_->component(end.component);
    return of;
}

BrowserService::Verdict BrowserService::reach(Pending& place, const browsing::Asker& asker, End end,
                                              Message::Run act) {
    Message call;
    call.run = act;
    call.object = &prepare(place, end);
    return await_engine(place, asker, end.component, call, &BrowserService::look_at_facet);
}

BrowserService::Verdict BrowserService::serve_force(Client& client, const Request& request) {
    End end;
    const MachineView& table = machine_->machine().table;
    if (const Sentence fault = find_port(table, request.arguments[0], end); !fault.empty())
        return {Refusal::unknown, fault};
    Pending* place = free_place(client.rights.role);
    const TypeTag& type = *facet_at(table, end).type;
    if (place == nullptr) return no_place();
    auto& call = place->work.emplace<FacetCall>();
    if (type.size > FacetCall::max_value_bytes)
        return {Refusal::unsupported, Sentence{"a value of more than ", FacetCall::max_value_bytes,
                                               " bytes cannot be forced; force what it is made of"}};
    if (const Sentence fault = parse_value(type, request.arguments[1], call.value.data()); !fault.empty())
        return {Refusal::bad_value, Sentence{"\"", request.arguments[0], "\": ", fault}};
    // A driver keeps what it sent last: after a release, a port that was never written would keep the forced
    // value.
    call.drives =
        is_input(facet_at(table, end)) && table.components[end.component].type->device_kind != nullptr;
    return reach(*place, asker(client, request), end, &force_port);
}

BrowserService::Verdict BrowserService::serve_release(Client& client, const Request& request) {
    End end;
    if (const Sentence fault = find_port(machine_->machine().table, request.arguments[0], end);
        !fault.empty())
        return {Refusal::unknown, fault};
    Pending* place = free_place(client.rights.role);
    if (place == nullptr) return no_place();
    place->work.emplace<FacetCall>();
    return reach(*place, asker(client, request), end, &release_port);
}

BrowserService::Verdict BrowserService::read_arguments(const Facet& facet, const Request& request,
                                                       std::span<std::byte> into) {
    // A command's results are part of its signature, but are returned, not passed.
    const TypeTag& list = facet.command != nullptr ? *facet.command->arguments : *facet.type;
    const auto types = list.elements;
    if (types.size() + 1 != request.arguments.size())
        return {Refusal::bad_value,
                Sentence{"\"", request.arguments[0], "\" takes ", types.size(), " arguments (", list.name,
                         ") and was given ", request.arguments.size() - 1}};
    std::size_t at = 0;
    for (std::size_t i = 0; i < types.size(); ++i) {
        if (at + types[i]->size > into.size())
            return {Refusal::unsupported, Sentence{"its arguments are too large to come from outside"}};
        // Packed arguments have no gaps; a value is parsed at an aligned place.
        alignas(16) std::array<std::byte, FacetCall::max_value_bytes> value{};
        if (types[i]->size > value.size())
            return {Refusal::unsupported, Sentence{"its arguments are too large to come from outside"}};
        const Sentence fault = parse_value(*types[i], request.arguments[i + 1], value.data());
        if (!fault.empty()) return {Refusal::bad_value, Sentence{"argument ", i + 1, ": ", fault}};
        std::memcpy(into.data() + at, value.data(), types[i]->size);
        at += types[i]->size;
    }
    return {};
}

BrowserService::Verdict BrowserService::serve_call(Client& client, const Request& request) {
    End end;
    const MachineView& table = machine_->machine().table;
    const Sentence unknown =
        browsing::find_facet(table, request.arguments[0], {FacetKind::method, FacetKind::operation}, end);
    if (!unknown.empty()) return {Refusal::unknown, unknown};
    const Facet& facet = facet_at(table, end);
    if (Verdict barred = check_facet(client, request.arguments[0], facet); !barred.good()) return barred;
    Pending* place = free_place(client.rights.role);
    if (place == nullptr) return no_place();
    auto& values = place->work.emplace<FacetCall>().value;
    if (Verdict read = read_arguments(facet, request, values); !read.good()) return read;
    if (facet.method != nullptr && facet.type->size + facet.method->result_bytes > values.size())
        return {Refusal::unsupported, Sentence{"its result is too large to be shown"}};
    const ActivityRow& activity = table.activities[machine_->machine().index.activity[end.component]];
    // Not here, even if it is any_thread: the requests of all other clients would wait for it.
    if (facet.may_block && activity.real_time)
        return {Refusal::unsupported,
                Sentence{"\"", request.arguments[0], "\" may block, and activity \"", activity.name,
                         "\" of its component is real-time; put the component into another activity"}};
    return reach(*place, asker(client, request), end, facet.method != nullptr ? &run_method : &run_operation);
}

bool BrowserService::look_at_facet(Pending& place) {
    if (!place.call.is_over()) return false;
    const auto& call = std::get<FacetCall>(place.work);
    if (call.refused)
        return answer_bad(place, Refusal::not_now,
                          Sentence{"component \"",
                                   machine_->machine().table.components[call.end.component].name,
                                   "\" does not run; start it first"});
    if (call.never_written)
        return answer_bad(
            place, Refusal::not_now,
            Sentence{"\"", machine_->machine().table.components[call.end.component].name, ".",
                     call.facet->name, "\" was not written yet: a release would have nothing to go back to; ",
                     call.drives ? "let its component write it first" : "force the inputs that read it"});
    const MethodOperations* method = call.facet->method;
    if (method == nullptr || method->result_bytes == 0) return answer_good(place);
    if (Client* client = who_waits(place)) {
        Reply reply{place.asker.number, true};
        alignas(16) std::array<std::byte, FacetCall::max_value_bytes> result{};
        std::memcpy(result.data(), call.value.data() + call.facet->type->size, method->result_bytes);
        reply.json().key("result");
        reply.value(*method->result, result.data());
        finish(*client, reply);
    }
    return true;
}

BrowserService::Verdict BrowserService::serve_set(Client& client, const Request& request) {
    const AcceptedMachine& machine = machine_->machine();
    if (request.arguments.size() % 2 != 0)
        return {Refusal::bad_request,
                Sentence{"each property needs its value; it is spelled: ", request.verb->usage}};
    Pending* place = free_place(client.rights.role);
    if (place == nullptr) return no_place();
    auto& transaction = place->work.emplace<PropertyTransaction>();
    End end;
    std::size_t component = nowhere;
    for (std::size_t i = 0; i < request.arguments.size(); i += 2) {
        const std::string_view name = request.arguments[i];
        const Sentence unknown = browsing::find_facet(machine.table, name, {FacetKind::property}, end);
        if (!unknown.empty()) return {Refusal::unknown, unknown};
        const ComponentRow& row = machine.table.components[end.component];
        if (component == nowhere) transaction.begin(row.name, *row.type, machine_->component(end.component));
        if (component != nowhere && component != end.component)
            return {Refusal::bad_request,
                    Sentence{"\"", name, "\" is a property of another component than \"",
                             machine.table.components[component].name,
                             "\": one transaction is of one component; send two"}};
        component = end.component;
        const Facet& facet = facet_at(machine.table, end);
        std::byte* value = transaction.change(end.facet);
        if (value == nullptr)
            return {Refusal::unsupported, Sentence{"one transaction does not hold so many; send several"}};
        if (const Sentence fault = parse_value(*facet.type, request.arguments[i + 1], value); !fault.empty())
            return {Refusal::bad_value, Sentence{"property \"", name, "\": ", fault}};
        if (const Sentence fault = check_range(facet, value); !fault.empty())
            return {Refusal::bad_value, fault};
    }
    return await_engine(*place, asker(client, request), component,
                        transaction.commit_message(machine.plan.part_of[component]),
                        &BrowserService::look_at_change);
}

bool BrowserService::look_at_change(Pending& place) {
    if (!place.call.is_over()) return false;
    const auto& transaction = std::get<PropertyTransaction>(place.work);
    if (transaction.state() == PropertyTransaction::State::refused)
        return answer_bad(place, Refusal::bad_value, transaction.refusal());
    if (Client* client = who_waits(place)) {
        Reply reply{place.asker.number, true};
        reply.json().field("set", transaction.values().size());
        finish(*client, reply);
    }
    return true;
}

} // namespace tappet
