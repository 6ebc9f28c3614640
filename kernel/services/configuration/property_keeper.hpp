// Saves properties periodically, so that a sudden end loses no more than one period of changes.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/os/terminal.hpp"
#include "kernel/services/configuration/property_saving.hpp"

namespace tappet {

/// In an activity that is not_real_time: it writes files. Saves every component whose row has a properties
/// file, each as it is between two of its steps.
///     component<PropertyKeeper>("keeper", set("every", 60s))
struct PropertyKeeper {
    static constexpr bool sees_machine = true;

    Output<std::int64_t> saved, failed;
    Property<Duration> every{60s};

    Sentence configure(Setup& setup) {
        machine_ = setup.machine;
        activity_ = activity_of(machine_->machine().table, setup.component);
        return {};
    }
    void start(const Cycle& cycle) noexcept {
        next_ = cycle.now + every.get();
        saved.write(0);
        failed.write(0);
    }
    void work(const Cycle& cycle) {
        if (saving_.busy()) {
            if (saving_.step()) return;
            saving_.fault().empty() ? saved.write(saved.last() + 1) : failed.write(failed.last() + 1);
            if (!saving_.fault().empty()) os::print(Sentence{"keeper: ", saving_.fault(), "\n"}.view());
        } else if (cycle.now >= next_) {
            next_ = cycle.now + every.get();
            saving_.begin(*machine_, activity_);
        }
    }

    static constexpr auto interface() {
        return facets(
            output<&PropertyKeeper::saved>("saved", "", "how often properties were saved, since start"),
            output<&PropertyKeeper::failed>("failed", "",
                                            "how often saving failed, since start; the console says why"),
            property<&PropertyKeeper::every>("every", "s", "time between two savings", range(1, 86400)));
    }

private:
    MachineInstance* machine_ = nullptr;
    std::size_t activity_ = nowhere;
    Time next_ = never;
    PropertySaving saving_{};
};

} // namespace tappet
