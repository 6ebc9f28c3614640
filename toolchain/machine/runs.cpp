// The two runs of a machine with its plant in one process.
#include "kernel/base/digest.hpp"
#include "kernel/os/host_watch.hpp"
#include "kernel/os/sleep.hpp"
#include "kernel/os/terminal.hpp"
#include "toolchain/machine/host.hpp"

namespace tappet {

std::uint64_t digest_of(const MachineInstance& instance, const Plant& plant) {
    Digest digest;
    digest.add(instance.observation().event_log_digest());
    digest.add(plant.digest());
    return digest.value();
}

VirtualRun::VirtualRun(const AcceptedMachine& machine, Plant& plant, std::uint64_t seed)
    : accepted_{machine}, devices_{plant, seed} {
    machine_.emplace(accepted_, clock_);
}

std::expected<void, Sentence> VirtualRun::start() {
    if (auto opened = devices_.open(accepted_); !opened) return opened;
    return start_machine();
}

std::expected<void, Sentence> VirtualRun::start_again() {
    machine_.emplace(accepted_, clock_);
    seen_steps_ = 0;
    if (auto opened = devices_.open_again(); !opened) return opened;
    return start_machine();
}

std::expected<void, Sentence> VirtualRun::start_machine() {
    instance().read_properties_from(files_.store());
    if (!browsed_in_.empty()) instance().browse_in(browsed_in_);
    if (auto configured = instance().configure(devices_.provided()); !configured)
        return std::unexpected(configured.error());
    if (timed_by_) machine_->world.take_times(*timed_by_);
    if (os::host_watch::is_linked()) watch_real_time_code();
    machine_->world.add({this,
                         [](void* self) {
                             auto& run = *static_cast<VirtualRun*>(self);
                             // The plant gets the machine's output on the wires at once.
                             if (run.seen_steps_ != run.world().steps()) {
                                 if (run.devices_.are_driven()) return run.clock_.now();
                                 run.seen_steps_ = run.world().steps();
                                 run.devices_.leap(run.world().quiet_until(self));
                             }
                             return run.devices_.next();
                         },
                         [](void* self, Time now) {
                             auto& run = *static_cast<VirtualRun*>(self);
                             run.seen_steps_ = run.world().steps();
                             run.devices_.advance(now);
                             if (run.look_) run.look_(now);
                             run.devices_.leap(run.world().quiet_until(self));
                         }});
    if (const Sentence refusal = machine_->world.start(); !refusal.empty()) return std::unexpected(refusal);
    return {};
}

// A twin is a simulation and may allocate: activities with a component on a device are left out.
void VirtualRun::watch_real_time_code() {
    const MachineView& table = accepted_.table;
    const auto engines = instance().engines();
    for (std::size_t a = 0; a < engines.size(); ++a) watched_[a] = engines[a].plan().real_time;
    for (std::size_t c = 0; c < table.components.size(); ++c)
        if (!table.components[c].device.empty()) watched_[accepted_.index.activity[c]] = false;
    static const bool sees_calls = os::host_watch::prepare(accepted_.table.name);
    static_cast<void>(sees_calls); // the heap and locks are watched all the same
    machine_->world.run_cycles_by({this, [](void* self, Engine& engine, bool woken) {
                                       auto& run = *static_cast<VirtualRun*>(self);
                                       const auto a = &engine - run.instance().engines().data();
                                       const bool is_watched = run.watched_[static_cast<std::size_t>(a)];
                                       os::host_watch::enter(engine.name(), is_watched);
                                       engine.run(woken);
                                       os::host_watch::leave();
                                   }});
}

void VirtualRun::stop() {
    machine_->world.stop();
    if (files_.keeps()) unsaved_ = instance().save_properties(instance().standing());
    if (!os::host_watch::is_linked()) return;
    static std::size_t told = 0; // once for each place in a program that runs many machines
    const auto uses = os::host_watch::uses();
    for (; told < uses.size(); ++told)
        static_cast<void>(os::write_all(
            2,
            Sentence{accepted_.table.name, ": activity \"", uses[told].activity, "\" is real-time but used ",
                     uses[told].what, ", ", os::host_watch::place_of(uses[told]), ", ", uses[told].cycles,
                     " times; on a box it may be late or break a contract. Reserve what it needs "
                     "before start, or run its component in an activity that is not_real_time\n"}
                .view()));
}

bool VirtualRun::run_until(const std::function<bool()>& done, Duration limit) {
    for (const Time end = clock_.now() + limit; !done();)
        if (clock_.now() >= end || !run_for(1ms)) return false;
    return true;
}

RealRun::RealRun(const AcceptedMachine& machine, Plant& plant, std::uint64_t seed)
    : devices_{plant, seed}, instance_{machine, clock_}, world_{instance_} {}

RealRun::~RealRun() { static_cast<void>(stop()); }

std::expected<void, Sentence> RealRun::start(int file) {
    if (auto opened = devices_.open(instance_.machine()); !opened) return opened;
    instance_.read_properties_from(files_.store());
    if (auto configured = instance_.configure(devices_.provided()); !configured)
        return std::unexpected(configured.error());
    const Board& board = *instance_.machine().board;
    os::ArmingReport arming{{board.only_warned.begin(), board.only_warned.end()}};
    const auto armed = world_.arm(arming, file);
    if (!armed) return std::unexpected(Sentence{"the machine refuses to arm; the reasons stand above"});
    plant_plan_ = {"plant", plant_priority, -1, plant_stack_, &RealRun::live, this};
    if (auto started = plant_thread_.start(plant_plan_); !started) return started;
    running_ = true;
    if (!world_.start(*armed) && !world_.refusal().empty()) return std::unexpected(world_.refusal());
    return {};
}

void RealRun::live(void* self) noexcept { static_cast<RealRun*>(self)->follow(); }

void RealRun::follow() {
    while (!plant_ends_.load(std::memory_order_acquire)) {
        const Time now = clock_.now();
        devices_.advance(now);
        done_.store(devices_.is_done(), std::memory_order_release);
        static_cast<void>(plant_waiter_.wait(now + plant_period));
    }
}

int RealRun::stop() {
    if (!running_) return 0;
    running_ = false;
    const int hung = world_.stop();
    os::sleep_for(coming_to_rest);
    plant_ends_.store(true, std::memory_order_release);
    plant_waiter_.wake();
    plant_thread_.join();
    if (files_.keeps()) unsaved_ = instance_.save_properties(instance_.standing());
    return hung;
}

} // namespace tappet
