// Requests that change something: prepared here, done by the engine that owns it, answered when it is done.
#include "kernel/services/browsing/browser_service.hpp"

#include "kernel/machine/instance/instance.hpp"
#include "kernel/services/browsing/names.hpp"

namespace tappet {

using browsing::Errand;

namespace {

bool is_input(const Facet& facet) noexcept TAPPET_REALTIME { return facet.kind == FacetKind::input; }

bool is_forced(const Errand& errand) noexcept TAPPET_REALTIME {
    return *errand.facet->port->places(errand.place, is_input(*errand.facet)).forced;
}

// What a component left behind when it stopped is its safe value: nothing is laid over that.
void force_port(Errand& errand) noexcept TAPPET_REALTIME {
    errand.refused = errand.machine->state_of(errand.component) >= ComponentState::stopping;
    if (errand.refused) return;
    // The count is for observers: nobody decides by it, so its sum is not used here.
    if (!is_forced(errand)) errand.machine->observed().forced.fetch_add(1, std::memory_order_relaxed);
    errand.facet->port->force(errand.place, is_input(*errand.facet), errand.value.data());
}

void release_port(Errand& errand) noexcept TAPPET_REALTIME {
    if (is_forced(errand)) errand.machine->observed().forced.fetch_sub(1, std::memory_order_relaxed);
    errand.facet->port->release(errand.place, is_input(*errand.facet));
}

void run_operation(Errand& errand) noexcept TAPPET_REALTIME {
    errand.facet->operation->run(errand.place, errand.value.data());
}

void run_method(Errand& errand) noexcept TAPPET_REALTIME {
    errand.facet->method->call_packed(errand.place, errand.value.data(),
                                      errand.value.data() + errand.argument_bytes);
}

/// Data ports are forced, buffered ones are not: which of its values would stand?
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

Errand* BrowserService::free_errand() noexcept {
    for (Errand& each : errands_) {
        if (each.taken) continue;
        each.given_up = each.refused = false;
        each.machine = machine_;
        return &each;
    }
    return nullptr;
}

BrowserService::Verdict BrowserService::check_alive(std::size_t component) noexcept {
    const AcceptedMachine& machine = machine_->machine();
    const std::size_t activity = machine.index.activity[component];
    for (const EnginePart& each : machine_->engines()[activity].plan().parts)
        if (each.state.load(std::memory_order_acquire) != ComponentState::stopped) return {};
    return {Refusal::not_now, Sentence{"activity \"", machine.table.activities[activity].name,
                                       "\" is stopped, and nothing of it can be changed; start it first"}};
}

BrowserService::Verdict BrowserService::run_errand(Client& client, const Request& request, Errand& errand,
                                                   End end) {
    const AcceptedMachine& machine = machine_->machine();
    if (Verdict alive = check_alive(end.component); !alive.good()) return alive;
    errand.component = end.component;
    errand.facet = &facet_at(machine.table, end);
    errand.place =
        errand.facet->port != nullptr ? machine_->place_of(end) : machine_->component(end.component);
    errand.asker = asker(client, request);
    if (!errand.post(machine.index.activity[end.component], machine.plan.part_of[end.component]))
        return {Refusal::not_now, Sentence{"that engine has too many requests to serve; ask again"}};
    errand.taken = true;
    return {};
}

BrowserService::Verdict BrowserService::force(Client& client, const Request& request) {
    End end;
    const MachineView& table = machine_->machine().table;
    if (const Sentence fault = find_port(table, request.arguments[0], end); !fault.empty())
        return {Refusal::unknown, fault};
    Errand* errand = free_errand();
    const TypeTag& type = *facet_at(table, end).type;
    if (errand == nullptr) return {Refusal::not_now, Sentence{"too many requests are under way; ask again"}};
    if (type.size > Errand::max_value_bytes)
        return {Refusal::unsupported, Sentence{"a value of more than ", Errand::max_value_bytes,
                                               " bytes cannot be forced; force what it is made of"}};
    if (const Sentence fault = parse_value(type, request.arguments[1], errand->value.data()); !fault.empty())
        return {Refusal::bad_value, Sentence{"\"", request.arguments[0], "\": ", fault}};
    errand->act = &force_port;
    return run_errand(client, request, *errand, end);
}

BrowserService::Verdict BrowserService::release(Client& client, const Request& request) {
    End end;
    if (const Sentence fault = find_port(machine_->machine().table, request.arguments[0], end);
        !fault.empty())
        return {Refusal::unknown, fault};
    Errand* errand = free_errand();
    if (errand == nullptr) return {Refusal::not_now, Sentence{"too many requests are under way; ask again"}};
    errand->act = &release_port;
    return run_errand(client, request, *errand, end);
}

// Its own forces ended with it; a forced input of another activity would still hide its safe value from
// there. False: not all could be asked for in this cycle.
bool BrowserService::release_behind(const LifeRequest& stopped) {
    const AcceptedMachine& machine = machine_->machine();
    const auto view = map::View::open(machine_->shared_memory());
    if (!view) return true;
    for (std::size_t x = 0; x < machine.table.connections.size(); ++x) {
        const Link& link = machine.index.connections[x];
        const std::size_t activity = machine.index.activity[link.to.component];
        const bool meant = stopped.component != nowhere
                               ? link.from.component == stopped.component
                               : machine.index.activity[link.from.component] == stopped.activity;
        const map::Facet& record =
            view->facets()[view->components()[link.to.component].first_facet + link.to.facet];
        if (!meant || record.forced_at == 0 || view->word<std::uint8_t>(record.forced_at) == 0 ||
            !check_alive(link.to.component).good())
            continue;
        Errand* errand = free_errand();
        if (errand == nullptr) return false;
        errand->facet = &facet_at(machine.table, link.to);
        errand->place = machine_->place_of(link.to);
        errand->act = &release_port;
        errand->asker = {.since = now_};
        errand->given_up = true; // nobody waits for its answer
        if (!errand->post(activity, machine.plan.part_of[link.to.component])) return false;
        errand->taken = true;
    }
    return true;
}

BrowserService::Verdict BrowserService::read_arguments(const Facet& facet, const Request& request,
                                                       std::span<std::byte> into) {
    // A command's results are part of its signature, but come back instead of going in.
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
        // Packed arguments stand without gaps, a value is read where it may stand.
        alignas(16) std::array<std::byte, Errand::max_value_bytes> value{};
        if (types[i]->size > value.size())
            return {Refusal::unsupported, Sentence{"its arguments are too large to come from outside"}};
        const Sentence fault = parse_value(*types[i], request.arguments[i + 1], value.data());
        if (!fault.empty()) return {Refusal::bad_value, Sentence{"argument ", i + 1, ": ", fault}};
        std::memcpy(into.data() + at, value.data(), types[i]->size);
        at += types[i]->size;
    }
    return {};
}

BrowserService::Verdict BrowserService::call(Client& client, const Request& request) {
    End end;
    const MachineView& table = machine_->machine().table;
    const Sentence unknown =
        browsing::find_facet(table, request.arguments[0], {FacetKind::method, FacetKind::operation}, end);
    if (!unknown.empty()) return {Refusal::unknown, unknown};
    const Facet& facet = facet_at(table, end);
    if (Verdict role = check_role(client, request.arguments[0], facet.least_role); !role.good()) return role;
    Errand* errand = free_errand();
    if (errand == nullptr) return {Refusal::not_now, Sentence{"too many requests are under way; ask again"}};
    if (Verdict read = read_arguments(facet, request, errand->value); !read.good()) return read;
    if (machine_->state_of(end.component) != ComponentState::running)
        return {Refusal::not_now, Sentence{"component \"", table.components[end.component].name,
                                           "\" does not run; start it first"}};
    errand->argument_bytes = facet.type->size;
    if (facet.method != nullptr && facet.type->size + facet.method->result_bytes > errand->value.size())
        return {Refusal::unsupported, Sentence{"its result is too large to be shown"}};
    errand->act = facet.method != nullptr ? &run_method : &run_operation;
    return run_errand(client, request, *errand, end);
}

void BrowserService::follow_errands() {
    for (Errand& each : errands_) {
        if (!each.taken) continue;
        if (each.is_over()) {
            each.taken = false;
            Client* client = each.given_up ? nullptr : door_.find(each.asker.client);
            if (client == nullptr || finish_behave(each)) continue;
            if (each.refused) {
                reply_bad(
                    each.asker, Refusal::not_now,
                    Sentence{"its component is stopped, and what it left behind is safe; start it first"});
                continue;
            }
            Reply reply{each.asker.number, true};
            if (each.act == &run_method && each.facet->method->result_bytes != 0) {
                alignas(16) std::array<std::byte, Errand::max_value_bytes> result{};
                std::memcpy(result.data(), each.value.data() + each.argument_bytes,
                            each.facet->method->result_bytes);
                reply.json().key("result");
                reply.value(*each.facet->method->result, result.data());
            }
            finish(*client, reply);
        } else if (now_ - each.asker.since > patience && each.withdraw() && !each.given_up) {
            each.given_up = true;
            reply_bad(each.asker, Refusal::not_now,
                      Sentence{"its engine did not come to it; nothing was done: look at its activity"});
        }
    }
}

BrowserService::Verdict BrowserService::set(Client& client, const Request& request) {
    const AcceptedMachine& machine = machine_->machine();
    if (request.arguments.size() % 2 != 0)
        return {Refusal::bad_request,
                Sentence{"each property needs its value; it is spelled: ", request.verb->usage}};
    Change* change = nullptr;
    for (Change& each : changes_)
        if (!each.taken) change = &each;
    if (change == nullptr) return {Refusal::not_now, Sentence{"too many changes are under way; ask again"}};
    PropertyTransaction& transaction = change->transaction;
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
        std::byte* place = transaction.change(end.facet);
        if (place == nullptr)
            return {Refusal::unsupported, Sentence{"one transaction does not hold so many; send several"}};
        if (const Sentence fault = parse_value(*facet.type, request.arguments[i + 1], place); !fault.empty())
            return {Refusal::bad_value, Sentence{"property \"", name, "\": ", fault}};
        if (const Sentence fault = PropertyTransaction::check_range(facet, place); !fault.empty())
            return {Refusal::bad_value, fault};
    }
    if (Verdict alive = check_alive(component); !alive.good()) return alive;
    change->asker = asker(client, request);
    change->given_up = false;
    const Message message = transaction.commit_message(machine.plan.part_of[component]);
    if (!machine_->post_request(machine.index.activity[component], message)) {
        transaction.reopen();
        return {Refusal::not_now, Sentence{"that engine has too many requests to serve; ask again"}};
    }
    change->taken = true;
    return {};
}

void BrowserService::follow_changes() {
    for (Change& each : changes_) {
        if (!each.taken) continue;
        if (each.transaction.finished()) {
            each.taken = false;
            Client* client = each.given_up ? nullptr : door_.find(each.asker.client);
            if (client == nullptr) continue;
            if (each.transaction.state() == PropertyTransaction::State::refused) {
                reply_bad(each.asker, Refusal::bad_value, each.transaction.refusal());
                continue;
            }
            Reply reply{each.asker.number, true};
            reply.json().field("set", each.transaction.values().size());
            finish(*client, reply);
        } else if (!each.given_up && now_ - each.asker.since > patience) {
            each.given_up = true;
            reply_bad(
                each.asker, Refusal::not_now,
                Sentence{"its engine did not come to it yet; read the property again: look at its activity"});
        }
    }
}

} // namespace tappet
