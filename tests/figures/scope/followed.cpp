// Whether a reader disturbs the writer: an engine's steps while another processor follows its tape cycle by
// cycle, in turns with steps without a reader.
#include "kernel/machine/accept.hpp"
#include "tests/figures/measure/ticks.hpp"
#include "tests/figures/measure/undisturbed.hpp"
#include "tests/figures/scope/machine.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <thread>

namespace tappet::figures {

namespace {

constexpr auto followed = ten_scoped; // in memory of its own

constexpr std::size_t steps_each = 16; ///< in one sample
constexpr std::size_t samples_each = 200;
constexpr std::size_t turns = 60; ///< of the short setting, followed and not

/// The other processor: reads all new records, either without a rest or every 100 us, which is a hundred
/// times as often as the browser does.
class Follower {
public:
    enum class Manner : std::uint8_t { not_at_all, now_and_then, at_once };
    explicit Follower(const CycleTape& tape) : tape_{tape}, thread_{[this] { run(); }} {}
    ~Follower() {
        ends_ = true;
        thread_.join();
    }
    Follower(const Follower&) = delete;
    Follower& operator=(const Follower&) = delete;
    void follow(Manner manner) { manner_.store(manner, std::memory_order_release); }
    [[nodiscard]] std::uint64_t cycles() const { return cycles_.load(std::memory_order_acquire); }

private:
    void run() {
        const Undisturbed here{1};
        while (!ends_.load(std::memory_order_relaxed)) {
            const Manner manner = manner_.load(std::memory_order_acquire);
            if (manner != Manner::at_once) std::this_thread::sleep_for(std::chrono::microseconds{100});
            if (manner == Manner::not_at_all) {
                seen_ = tape_.head();
                continue;
            }
            const std::uint64_t head = tape_.head();
            TapeCycle cycle;
            std::array<std::uint64_t, 16> marks{};
            for (std::uint64_t after = head; after > seen_ && tape_.cycle_before(after, cycle);
                 after = cycle.at)
                if (cycle.marks <= marks.size() && tape_.copy(cycle.at, std::span{marks}.first(cycle.marks)))
                    cycles_.fetch_add(1, std::memory_order_relaxed);
            seen_ = head;
        }
    }
    const CycleTape& tape_;
    std::uint64_t seen_ = 0;
    std::atomic<bool> ends_{false};
    std::atomic<Manner> manner_{Manner::not_at_all};
    std::atomic<std::uint64_t> cycles_{0};
    std::thread thread_;
};

} // namespace

void add_followed(const Options& options, Result& result) {
    if (std::thread::hardware_concurrency() < 2) {
        result.notes.push_back("scope.followed: one processor; nobody can follow a step while it runs");
        return;
    }
    static World world{os::Clock::Kind::real, AtRunTime<followed, figures_board>::machine()};
    Engine& engine = world.engine();
    const Undisturbed here{0};
    Follower follower{scope::tape(directory_of(world), 0)};
    const double unit = ns_per_tick() / steps_each;
    const auto reading = static_cast<double>(ticks_of_reading());
    std::array<Samples, 3> samples;
    std::array<std::uint64_t, 3> read{};
    const auto all = static_cast<std::size_t>(std::max(2.0, static_cast<double>(turns) * options.scale()));
    for (std::size_t turn = 0; turn < all; ++turn)
        for (std::size_t manner = 0; manner < samples.size(); ++manner) {
            follower.follow(static_cast<Follower::Manner>(manner));
            std::this_thread::sleep_for(std::chrono::milliseconds{2}); // both rest, and the other one notices
            const std::uint64_t before = follower.cycles();
            for (std::size_t i = 0; i < samples_each; ++i) {
                const std::uint64_t begin = ticks();
                for (std::size_t k = 0; k < steps_each; ++k) engine.run(true);
                const auto took = static_cast<double>(ticks() - begin);
                samples[manner].add(std::max(0.0, took - reading) * unit);
            }
            read[manner] += follower.cycles() - before;
        }
    result.figures.push_back({"scope.followed",
                              "step of an engine with ten components, its tape read by another processor",
                              "ns",
                              "thesis A.2.1",
                              "mean of 16 in a row; steps that are followed and not in turns",
                              {{"read each 100 us", Standing::ours, samples[1].summary()},
                               {"each cycle is read at once", Standing::ours, samples[2].summary()},
                               {"nobody reads", Standing::floor, samples[0].summary()}}});
    const auto tell = [&](std::size_t manner) {
        std::array<char, 200> text{};
        const double share =
            static_cast<double>(read[manner]) / static_cast<double>(all * samples_each * steps_each);
        std::snprintf(text.data(), text.size(),
                      "%.1f ns against %.1f ns; %.0f %% of the cycles were read meanwhile",
                      samples[manner].median(), samples[0].median(), 100 * share);
        return std::string{text.data()};
    };
    result.statements.push_back(
        {"a reader on another processor that looks each 100 us makes the step that writes "
         "the tape slower by less than 2 %",
         samples[1].median() < 1.02 * samples[0].median(), tell(1)});
    result.statements.push_back(
        {"one that takes every cycle as soon as it is there, without a rest, by less than a "
         "tenth",
         samples[2].median() < 1.1 * samples[0].median(), tell(2)});
    result.notes.push_back("scope.followed: the engine steps without a rest, some three million times a "
                           "second, so that every store "
                           "waits for the one before it; a line of the tape that was read must be fetched "
                           "back when it is written "
                           "again, one or two lines in a cycle of ten functions");
    if (!here.refused().empty()) result.notes.push_back("scope.followed: " + here.refused());
}

} // namespace tappet::figures
