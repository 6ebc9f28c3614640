// A program or state machine as a light-weight task (thesis 5.1.6, 5.2.5): commands change its status,
// methods read it, its variables are properties, and a program with parameters is a command. It is a
// component like any other: rows, scripts and browsers use it in the same way.
//
//     component<BehaviourTask<weft_script, "feed">>("feeding", controls("weft"), set("speed", 0.5)),
//     uses("console.feed", "feeding.run")          // program feed(int pieces, double speed) { ... } of it
//
// It controls the behaviour that drives the component: that script, compiled with the machine, or any loaded
// behaviour of the same shape in the component's slot.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/component/component.hpp"
#include "kernel/machine/instance/controlled.hpp"
#include "kernel/machine/slots/behaviour_action.hpp"
#include "kernel/script/unit.hpp"
#include "kernel/services/tasks/task_values.hpp"

namespace tappet {

namespace detail {

/// Commands and methods that every behaviour has.
class AnyBehaviourTask {
public:
    static constexpr auto controls = ComponentType::Controls::behaviour;
    void control(const Controlled& controlled) noexcept { controlled_ = controlled; }

    // Commands; rejected while nothing is loaded, or in a status that does not permit them.
    bool start_it() noexcept TAPPET_REALTIME { return acts(BehaviourAction::start); }
    bool stop_it() noexcept TAPPET_REALTIME { return acts(BehaviourAction::stop); }
    bool pause_it() noexcept TAPPET_REALTIME { return acts(BehaviourAction::pause); }
    bool step_once() noexcept TAPPET_REALTIME { return acts(BehaviourAction::step); }
    bool reset_it() noexcept TAPPET_REALTIME { return acts(BehaviourAction::reset); }
    bool make_reactive() noexcept TAPPET_REALTIME { return acts(BehaviourAction::reactive); }
    bool deactivate_it() noexcept TAPPET_REALTIME { return acts(BehaviourAction::deactivate); }
    bool request(const ScriptText& state) noexcept TAPPET_REALTIME {
        return acts(BehaviourAction::request, find(state.view()));
    }

    CommandProgress is_stopped() noexcept TAPPET_REALTIME {
        return until([](const UnitPart& part) noexcept TAPPET_REALTIME {
            return is_at_rest(part) ? CommandProgress::done : CommandProgress::executing;
        });
    }
    CommandProgress is_deactivated() noexcept TAPPET_REALTIME {
        return until([](const UnitPart& part) noexcept TAPPET_REALTIME {
            return part.machine != nullptr && part.machine->is_active() ? CommandProgress::executing
                                                                        : CommandProgress::done;
        });
    }
    /// Fails when the program was stopped, by anyone, before its end.
    CommandProgress has_ended() noexcept TAPPET_REALTIME {
        return until([](const UnitPart& part) noexcept TAPPET_REALTIME {
            if (!is_at_rest(part)) return CommandProgress::executing;
            return part.program->has_ended() ? CommandProgress::done : CommandProgress::failed;
        });
    }
    CommandProgress is_requested(const ScriptText& state) noexcept TAPPET_REALTIME {
        const StateIndex wanted = find(state.view());
        return until([wanted](const UnitPart& part) noexcept TAPPET_REALTIME {
            if (part.machine->is_in(wanted)) return CommandProgress::done;
            const bool waits = part.machine->request_waits() || part.machine->under_way();
            return waits ? CommandProgress::executing : CommandProgress::failed;
        });
    }

    // Methods.
    bool is_active() noexcept TAPPET_REALTIME {
        const UnitPart* part = controlled_.behaviour();
        if (part == nullptr) return false;
        return part->machine != nullptr ? part->machine->is_active() : !is_at_rest(*part);
    }
    bool is_paused() noexcept TAPPET_REALTIME {
        const UnitPart* part = controlled_.behaviour();
        if (part == nullptr) return false;
        return part->machine != nullptr ? part->machine->is_paused()
                                        : part->program->status() == ProgramStatus::paused;
    }
    bool in_error() noexcept TAPPET_REALTIME {
        const UnitPart* part = controlled_.behaviour();
        return part != nullptr && is_in_error(*part);
    }
    bool is_in(const ScriptText& state) noexcept TAPPET_REALTIME {
        const UnitPart* part = controlled_.behaviour();
        const StateIndex wanted = find(state.view());
        return part != nullptr && wanted != no_state && part->machine->is_in(wanted);
    }

protected:
    /// Whether the program may be started; first clears its error, like a stop.
    [[nodiscard]] bool is_free() noexcept TAPPET_REALTIME {
        const UnitPart* part = controlled_.behaviour();
        if (part == nullptr || !controlled_.active()->may_begin() || !is_at_rest(*part)) return false;
        return !is_in_error(*part) || acts(BehaviourAction::stop);
    }
    Controlled controlled_{};

private:
    static bool is_in_error(const UnitPart& part) noexcept TAPPET_REALTIME {
        return part.machine != nullptr ? part.machine->in_error()
                                       : part.program->status() == ProgramStatus::error;
    }
    bool acts(BehaviourAction action, StateIndex state = no_state) noexcept TAPPET_REALTIME {
        UnitPart* const part = controlled_.behaviour();
        if (part == nullptr || (action == BehaviourAction::request && state == no_state)) return false;
        if (!act(*controlled_.active(), *part, action, state, controlled_.engine->now())) return false;
        commanded_ = part;
        await_rest(*part);
        return true;
    }
    // Another behaviour may have taken over since the command.
    template <class How> CommandProgress until(const How& how) noexcept TAPPET_REALTIME {
        const UnitPart* part = controlled_.behaviour();
        if (part == nullptr || part != commanded_ || is_in_error(*part)) return CommandProgress::failed;
        return how(*part);
    }
    [[nodiscard]] StateIndex find(std::string_view state) noexcept TAPPET_REALTIME {
        const UnitPart* part = controlled_.behaviour();
        if (part == nullptr || part->machine == nullptr) return no_state;
        const auto states = part->type->machine.states;
        for (std::size_t i = 0; i < states.size(); ++i)
            if (states[i].name == state) return static_cast<StateIndex>(i);
        return no_state;
    }

    const UnitPart* commanded_ = nullptr;
};

/// Returns the numbers of the variables that a task of that instance has: its properties, and a program's
/// result.
template <const auto& script, std::size_t number, std::size_t... i>
constexpr auto task_variables(std::index_sequence<i...>) {
    constexpr const BehaviourInstance& instance = script.instances[number];
    constexpr const BehaviourType& type = script.types[instance.type];
    [[maybe_unused]] constexpr auto is_wanted = [](const VariableRow& row) {
        if (row.name.empty() || row.at == no_data) return false;
        return row.kind == VariableKind::parameter || row.kind == VariableKind::result ||
               (row.kind == VariableKind::variable && !type.is_program());
    };
    [[maybe_unused]] constexpr std::array<bool, sizeof...(i)> wanted{is_wanted(type.tables.variables[i])...};
    constexpr std::array<bool, sizeof...(i)> known{
        (wanted[i] && task_property<type.tables.variables[i].type> != nullptr)...};
    static_assert(
        !instance.on_command ||
            ((!wanted[i] || !std::is_void_v<TaskValue<type.tables.variables[i].type>>) && ...),
        "a program that is told to run from outside takes and gives bool, int, double, duration and text");
    std::array<std::uint16_t, (std::size_t{0} + ... + known[i])> numbers{};
    std::size_t at = 0;
    for (std::size_t v = 0; v < sizeof...(i); ++v)
        if (known[v]) numbers[at++] = static_cast<std::uint16_t>(v);
    return numbers;
}

} // namespace detail

/// A script that the compiler does not know: a C++ table, or the present contents of a slot.
inline constexpr ScriptUnit any_script{};

/// In the table: component<BehaviourTask<script, "instance">>("name", controls("component")), in the activity
/// of that component. `script`: the ScriptUnit that drives it, or the shape of the scripts for its slot: an
/// instance of that name with those variables and parameters; loading refuses any other. Without a script the
/// task has only commands and methods, which apply to the first program or machine that it finds. Properties
/// are the variables and parameters of a machine and the parameters of a program (whose variables are
/// initialised at each start), except those of record types; the row may set them, and a properties file may
/// keep them. The properties of a slot's task stay when behaviours change: one that takes over receives them,
/// one that is rolled back has changed none. `run` of a program sets its parameters and returns its result,
/// if it has one; `start` uses the present parameters. Commands and methods are real-time.
template <const auto& script = any_script, text instance = "">
struct BehaviourTask : detail::AnyBehaviourTask {
    static constexpr bool knows_script = !script.types.empty();
    static constexpr const ScriptUnit* script_unit = knows_script ? &script : nullptr;
    static constexpr std::string_view instance_name = instance.view();
    static_assert(knows_script || instance_name.empty(),
                  "name the script whose instance this is the task of");
    static constexpr std::size_t number = [] {
        for (std::size_t i = 0; i < script.instances.size(); ++i)
            if (script.instances[i].name == instance_name) return i;
        return std::size_t{0};
    }();
    /// Null: the type is not known.
    static constexpr const BehaviourType* type =
        knows_script ? &script.types[script.instances[number].type] : nullptr;
    static constexpr bool may_be_machine = type == nullptr || !type->is_program();
    static constexpr bool is_command = type != nullptr && script.instances[number].on_command;

    void control(const Controlled& controlled) noexcept {
        AnyBehaviourTask::control(controlled);
        static_assert(known.size() <= SlotTask::max_variables,
                      "a task has at most 64 variables: split the behaviour");
        if constexpr (knows_script)
            if (controlled.slot != nullptr) {
                in_slot_.place(controlled.name, {&script.instances[number], type, known},
                               {values_, seen_, places_});
                controlled.slot->add(in_slot_);
                controlled_.task = &in_slot_;
            }
    }
    /// Passes changed properties to the loaded behaviour.
    void changed() noexcept TAPPET_REALTIME {
        if (controlled_.slot != nullptr) controlled_.slot->exchange();
    }

    static constexpr auto interface() {
        std::array<Facet, facet_count> all{};
        std::size_t at = 0;
        visit([&](const Facet& facet) { all[at++] = facet; });
        return all;
    }

private:
    using Self = BehaviourTask;
    static constexpr auto known = [] {
        if constexpr (knows_script)
            return detail::task_variables<script, number>(
                std::make_index_sequence<type->tables.variables.size()>{});
        else
            return std::array<std::uint16_t, 0>{};
    }();
    template <std::size_t i> using Value = detail::TaskValue<type->tables.variables[known[i]].type>;

    // ---- a program that is a command: its parameters, which precede all other variables, and its result

    static constexpr std::size_t parameters = is_command ? type->parameters() : 0;
    static constexpr bool gives_result = is_command && known.size() != parameters;
    template <class, class...> struct Run;
    template <std::size_t... i, class... R> struct Run<std::index_sequence<i...>, R...> {
        using Pack = detail::Packing<Value<i>..., R&...>;
        static bool begin(void* component, std::byte* values) noexcept TAPPET_REALTIME {
            auto& task = *static_cast<Self*>(component);
            if (!task.is_free()) return false;
            task.controlled_.behaviour()->program->give(values);
            return task.start_it();
        }
        static CommandProgress progress(void* component, [[maybe_unused]] std::byte* values) noexcept
            TAPPET_REALTIME {
            auto& task = *static_cast<Self*>(component);
            const CommandProgress progress = task.has_ended();
            if constexpr (gives_result)
                if (progress == CommandProgress::done)
                    task.controlled_.behaviour()->program->take_result(values + Pack::input_bytes);
            return progress;
        }
        static constexpr CommandOperations operations{type_id<typename Pack::Inputs>,
                                                      type_id<typename Pack::Results>,
                                                      Pack::input_bytes,
                                                      Pack::result_bytes,
                                                      &GatedCommand<&begin, &progress>::begin,
                                                      &GatedCommand<&begin, &progress>::progress};
        static constexpr Facet facet{.name = "run",
                                     .doc = "executes it with these parameters, to its end",
                                     .kind = FacetKind::command,
                                     .type = type_id<Arguments<Value<i>..., Result<R>...>>,
                                     .command = &operations};
    };

    // ---- properties

    static constexpr bool is_command_name(std::string_view name) {
        for (const std::string_view each :
             {"start", "stop", "pause", "step", "reset", "run", "deactivate", "reactive", "request",
              "is_active", "is_paused", "in_error", "is_in"})
            if (each == name) return true;
        return false;
    }
    /// The properties of a slot's task are stored here: the loaded behaviours change.
    static void* property_at(void* component, std::size_t i) noexcept {
        auto& task = *static_cast<Self*>(component);
        if (task.controlled_.slot == nullptr)
            return task.controlled_.behaviour()->data + type->tables.variables[known[i]].at;
        return task.values_.data() + TaskShape::place_of(*type, known[i]);
    }
    template <std::size_t i, class Visit> static constexpr void visit_variable(const Visit& visitor) {
        constexpr VariableRow row = type->tables.variables[known[i]];
        if constexpr (row.kind != VariableKind::result) {
            static_assert(!is_command_name(row.name), "a variable of the script has the name of a command or "
                                                      "method of its task; rename it in the script");
            visitor(Facet{.name = row.name,
                          .doc = row.kind == VariableKind::parameter ? "a parameter" : "a variable",
                          .kind = FacetKind::property,
                          .type = row.type,
                          .index = i,
                          .at = &property_at,
                          .property = detail::task_property<row.type>});
        }
    }
    template <class Visit, std::size_t... i>
    static constexpr void visit_variables(const Visit& visitor, std::index_sequence<i...>) {
        (visit_variable<i>(visitor), ...);
    }

    template <class Visit> static constexpr void visit(const Visit& visitor) {
        visitor(command<&Self::start_it>("start", "a program runs, a machine is active and goes by itself"));
        visitor(command<&Self::stop_it, &Self::is_stopped>("stop", "to its end, or to its final state"));
        visitor(command<&Self::pause_it>("pause", "where it stands"));
        visitor(command<&Self::step_once>("step", "one statement or question of what is paused"));
        visitor(
            command<&Self::reset_it>("reset", "to its beginning, or from the final to the initial state"));
        visitor(method<&Self::is_active>("is_active", "it runs, or is in a state"));
        visitor(method<&Self::is_paused>("is_paused", "it stands where it was paused"));
        visitor(method<&Self::in_error>("in_error", "a program of it failed"));
        if constexpr (may_be_machine) {
            visitor(command<&Self::deactivate_it, &Self::is_deactivated>("deactivate", "out of its states"));
            visitor(command<&Self::make_reactive>("reactive", "it hears events and requests only"));
            visitor(command<&Self::request, &Self::is_requested>(
                "request", "the transition to a state, if its guard holds"));
            visitor(method<&Self::is_in>("is_in", "that state is active"));
        }
        if constexpr (gives_result)
            visitor(Run<std::make_index_sequence<parameters>, Value<parameters>>::facet);
        else if constexpr (is_command)
            visitor(Run<std::make_index_sequence<parameters>>::facet);
        visit_variables(visitor, std::make_index_sequence<known.size()>{});
    }
    static constexpr std::size_t facet_count = [] {
        std::size_t count = 0;
        visit([&](const Facet&) { ++count; });
        return count;
    }();

    // For the task of a slot.
    static constexpr std::size_t value_bytes = knows_script ? TaskShape::value_bytes(*type) : 0;
    SlotTask in_slot_{};
    alignas(data_alignment) std::array<std::byte, value_bytes> values_{}, seen_{};
    std::array<DataOffset, 2 * known.size()> places_{};
};

} // namespace tappet
