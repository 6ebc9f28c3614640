// Saves one component after the other: posts a request, its engine copies the values, then writes the file.
#include "kernel/services/configuration/property_saving.hpp"

namespace tappet {

void PropertySaving::begin(MachineInstance& machine, std::size_t activity, std::size_t component) noexcept {
    if (busy_) return;
    machine_ = &machine, activity_ = activity;
    next_ = component == nowhere ? 0 : component;
    end_ = component == nowhere ? machine.machine().table.components.size() : component + 1;
    saved_ = 0;
    fault_ = Sentence{};
    busy_ = true;
    asked_ = gave_up_ = false;
    asked_at_ = machine.clock().now();
}

bool PropertySaving::step() noexcept {
    if (!busy_) return false;
    const auto components = machine_->machine().table.components;
    if (asked_) {
        if (!call_.is_over() && machine_->clock().now() - asked_at_ < patience) return true;
        if (call_.withdraw())
            give_up();
        else if (!call_.is_over())
            return true; // it is being copied
        else
            write();
        asked_ = false;
        asked_at_ = machine_->clock().now();
        ++next_;
    } else if (next_ < end_ && machine_->clock().now() - asked_at_ > patience) {
        give_up(); // there was no room for the request
        asked_at_ = machine_->clock().now();
        ++next_;
    }
    while (next_ < end_ && (!components[next_].has_properties_file || !is_reached())) ++next_;
    if (next_ == end_)
        busy_ = false;
    else
        ask(next_);
    return busy_;
}

/// False: its engine serves no requests, and that is reported.
bool PropertySaving::is_reached() noexcept {
    const std::size_t activity = machine_->machine().index.activity[next_];
    if (is_alive(*machine_, activity)) return true;
    give_up();
    return false;
}

void PropertySaving::ask(std::size_t component) noexcept {
    const AcceptedMachine& machine = machine_->machine();
    const ComponentRow& row = machine.table.components[component];
    copy_.begin(row.name, *row.type, machine_->component(component));
    copy_.change_all();
    const std::size_t activity = machine.index.activity[component];
    if (activity == activity_)
        copy_.capture();
    else if (!call_.post(*machine_, activity, copy_.capture_message(machine.plan.part_of[component]),
                         Role::engineer))
        return; // its engine is busy: try again in the next step, for a while
    asked_at_ = machine_->clock().now();
    asked_ = true;
}

void PropertySaving::give_up() noexcept {
    const AcceptedMachine& machine = machine_->machine();
    gave_up_ = true;
    if (fault_.empty())
        fault_ = Sentence{
            "component \"", machine.table.components[next_].name,
            "\": its properties are not saved, since its engine did not execute it in time: look at "
            "activity \"",
            machine.table.activities[machine.index.activity[next_]].name, "\"; the old file remains"};
}

void PropertySaving::write() noexcept {
    const ComponentRow& row = machine_->machine().table.components[next_];
    const PropertyStore& store = machine_->property_store();
    const Sentence fault =
        store.save == nullptr
            ? Sentence{"component \"", row.name,
                       "\": this firmware keeps no properties; give its start-up read_properties_from(...)"}
            : store.save(store.self, row, copy_);
    if (fault.empty())
        ++saved_;
    else if (fault_.empty())
        fault_ = fault;
}

} // namespace tappet
