// Arms, starts, supervises and stops the threads of a machine.
#include "kernel/machine/real_world.hpp"

#include "kernel/base/contract.hpp"
#include "kernel/os/heap.hpp"
#include "kernel/os/memory.hpp"
#include "kernel/os/signals.hpp"
#include "kernel/os/sleep.hpp"

namespace tappet {

namespace {

// A contract handler and a signal handler have no argument of ours: they find the world here.
std::atomic<RealWorld*> current_world{nullptr};
std::atomic<os::Waiter*> signal_waiter{nullptr};
std::atomic<bool> signal_came{false};

} // namespace

RealWorld::RealWorld(MachineInstance& instance) noexcept : instance_{instance} {
    current_world.store(this, std::memory_order_release);
    signal_waiter.store(&instance.supervisor(), std::memory_order_release);
    signal_came.store(false);
    install_contract_handler(&RealWorld::on_breach);
    os::on_termination(&RealWorld::on_signal);
}

RealWorld::~RealWorld() {
    static_cast<void>(stop());
    install_contract_handler(nullptr);
    os::on_termination(nullptr);
    signal_waiter.store(nullptr);
    current_world.store(nullptr);
}

void RealWorld::on_signal(int) noexcept {
    signal_came.store(true, std::memory_order_release);
    if (os::Waiter* waiter = signal_waiter.load(std::memory_order_acquire)) waiter->wake();
}

void RealWorld::on_breach(const Breach& breach) noexcept TAPPET_REALTIME {
    RealWorld* world = current_world.load(std::memory_order_acquire);
    if (world == nullptr) return;
    Activity* activity = Activity::current();
    const bool first = !world->instance_.stop_asked();
    if (first)
        TAPPET_ESCAPE("the machine is stopping: the sentence is for its report",
                      world->breach_ = describe(breach));
    world->instance_.ask_stop(StopReason::broken_contract, static_cast<std::uint64_t>(breach.id),
                              activity == nullptr ? nullptr : &activity->engine());
    const ContractText* text = find_text(breach.id);
    const bool goes_on = text != nullptr && text->after == AfterBreach::thread_goes_on;
    if (!goes_on && activity != nullptr) activity->park();
}

bool RealWorld::arm(os::ArmingReport& report, int file) {
    const auto& machine = instance_.machine();
    os::touch(machine.memory); // before there are threads: their stacks are part of it
    const auto engines = instance_.engines();
    int highest = 1;
    Bounded<int, checks::max_activities> processors;
    os::minimise_timer_slack(); // threads inherit it
    for (std::size_t a = 0; a < engines.size(); ++a) {
        const ActivityPlan& plan = machine.plan.activities[a];
        if (const auto created = activities_[a].create(engines[a], instance_.clock(), plan.priority,
                                                       plan.processor, instance_.stack_of(a));
            !created)
            report.fault("threads", created.error(), Sentence{"see the reason"});
        if (plan.priority > highest) highest = plan.priority;
        static_cast<void>(processors.push(plan.processor));
    }
    if (const auto locked = os::lock_memory(); !locked)
        report.fault("memory-lock", locked.error(), Sentence{"see the reason"});
    if (auto held = os::hold_cpu_dma_latency(); held) latency_ = std::move(*held);
    os::heap::seal();
    os::ArmingOptions options;
    options.processors = {processors.begin(), processors.end()};
    options.highest_priority = highest;
    check_system(report, options, os::observe_process(highest));
    const bool fit = report.conclude();
    print(report, file);
    if (!fit) os::heap::release();
    return fit;
}

ActivityControl RealWorld::control() noexcept {
    return {this,
            [](void* self, std::size_t a) {
                return static_cast<RealWorld*>(self)->activities_[a].start(patience_ms);
            },
            [](void* self, std::size_t a) { return static_cast<RealWorld*>(self)->stop_engine(a); }};
}

bool RealWorld::start() {
    refusal_ = instance_.start_activities(control());
    if (!refusal_.empty()) static_cast<void>(stop());
    return refusal_.empty();
}

Sentence RealWorld::change_activity(std::size_t activity, LifeChange change) {
    return instance_.change_activity(activity, change, control());
}

bool RealWorld::stop_engine(std::size_t a) noexcept {
    if (activities_[a].stop(patience_ms)) return true;
    // Parked by a broken contract, or hung: its components still leave their safe values.
    if (activities_[a].claim_engine_stop()) activities_[a].engine().stop(instance_.clock().now());
    activities_[a].engine().mark_failed();
    activities_[a].abandon(); // the process must end although this thread never does
    return false;
}

bool RealWorld::supervise(Duration time) {
    const Time end = instance_.clock().now() + time;
    while (!instance_.stop_asked()) {
        instance_.serve_activity_requests(control());
        if (signal_came.load(std::memory_order_acquire)) {
            instance_.ask_stop(StopReason::requested, 0, nullptr);
            return false;
        }
        if (instance_.clock().now() >= end) return true;
        static_cast<void>(instance_.supervisor().wait(end));
    }
    return false;
}

int RealWorld::stop() {
    int hung = 0;
    for (std::size_t a = instance_.engines().size(); a-- > 0;)
        hung += !instance_.change_activity(a, LifeChange::stop, control()).empty();
    for (std::size_t a = instance_.engines().size(); a-- > 0;)
        if (!activities_[a].end(patience_ms)) activities_[a].abandon();
    os::heap::release();
    return hung;
}

std::uint64_t RealWorld::page_faults_in_real_time_threads() const noexcept {
    std::uint64_t faults = 0;
    for (std::size_t a = 0; a < instance_.engines().size(); ++a)
        if (instance_.engines()[a].plan().real_time)
            faults += activities_[a].page_faults().minor + activities_[a].page_faults().major;
    return faults;
}

} // namespace tappet
