// A run under real time: the plant's thread, and the order of start and stop.
#include "apps/carpet_loom/host/real_run.hpp"

#include "apps/carpet_loom/console.hpp"
#include "apps/carpet_loom/host/loom_on_host.hpp"
#include "kernel/os/sleep.hpp"

namespace tappet::carpet {

RealRun::RealRun(const loom::Settings& settings, std::uint64_t seed, bool quiet)
    : loom_{settings, seed}, instance_{loom_on_host(), clock_}, world_{instance_}, quiet_{quiet} {}

RealRun::~RealRun() { static_cast<void>(stop()); }

std::expected<void, Sentence> RealRun::start(int file) {
    if (auto opened = loom_.open(); !opened) return opened;
    instance_.read_properties_from(properties_on_host());
    if (auto configured = instance_.configure(loom_.devices()); !configured)
        return std::unexpected(configured.error());
    instance_.find<Console>("console")->quiet.set(quiet_);
    const Board& board = *instance_.machine().board;
    os::ArmingReport arming{{board.only_warned.begin(), board.only_warned.end()}};
    const auto armed = world_.arm(arming, file);
    if (!armed) return std::unexpected(Sentence{"the machine refuses to arm; the reasons stand above"});
    loom_.begin_at(clock_.now());
    plant_plan_ = {"plant", plant_priority, -1, plant_stack_, &RealRun::live, this};
    if (auto started = plant_thread_.start(plant_plan_); !started) return started;
    running_ = true;
    if (!world_.start(*armed)) return std::unexpected(world_.refusal());
    return {};
}

void RealRun::live(void* self) noexcept { static_cast<RealRun*>(self)->follow(); }

void RealRun::follow() noexcept {
    while (!plant_ends_.load(std::memory_order_acquire)) {
        const Time now = clock_.now();
        loom_.advance(now);
        picks_.store(loom_.plant().picks(), std::memory_order_relaxed);
        stands_.store(loom_.plant().speed_rpm() == 0.0, std::memory_order_relaxed);
        static_cast<void>(plant_waiter_.wait(now + plant_period));
    }
}

bool RealRun::weave(std::uint64_t picks, Duration limit) {
    const Time end = clock_.now() + limit;
    while (clock_.now() < end) {
        if (picks_.load(std::memory_order_relaxed) >= picks && stands_.load(std::memory_order_relaxed))
            return true;
        if (!world_.supervise(50ms)) return false;
    }
    return false;
}

int RealRun::stop() {
    if (!running_) return 0;
    running_ = false;
    const int hung = world_.stop();
    os::sleep_for(300ms); // the brake has bitten and the shaft stands
    plant_ends_.store(true, std::memory_order_release);
    plant_waiter_.wake();
    plant_thread_.join();
    return hung;
}

} // namespace tappet::carpet
