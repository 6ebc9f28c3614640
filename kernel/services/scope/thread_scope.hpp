// The thread scope (thesis A.2.1) and flight recorder. With it in the table every cycle of every activity is
// recorded, function by function, and the worst cycles of the last hour are kept with everything around them.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/machine/plan/scope_layout.hpp"

namespace tappet {

/// Runs in an activity that is not_real_time and polls several times in 100 ms: a tape holds that much time
/// of an activity that runs as often as its row says, and less of a very busy one; overwritten cycles are
/// counted.
///     component<ThreadScope>("scope") ... activity("browser", every(20ms), not_real_time, runs("scope"))
/// The engines write their tapes themselves, wait-free, with a mark for each function from stamps that they
/// take anyway, and publish a cycle after its last stamp. Without this row in the table, or while `on` is
/// false, this costs them one test. The kept cycles are in the machine's shared memory: `tappet-browse scope`
/// shows them, and writes them as VCD or as a trace for Perfetto.
class ThreadScope {
public:
    static constexpr bool records_cycles = true;

    Output<std::int64_t> judged, taken;
    Property<bool> on{true};
    Property<bool> by_busy{false};
    Property<Duration> span{1h}, before{2ms}, after{2ms};

    Sentence configure(Setup& setup);
    Sentence initialise();
    void work(const Cycle& cycle);
    void forget() noexcept TAPPET_REALTIME { forgets_ = true; }

    static constexpr auto interface() {
        return facets(
            output<&ThreadScope::judged>("judged", "", "cycles of real-time activities that were looked at"),
            output<&ThreadScope::taken>("taken", "", "cycles that were kept when they were the worst so far"),
            property<&ThreadScope::on>("on", "", "cycles are recorded"),
            property<&ThreadScope::by_busy>("by_busy", "",
                                            "the worst is the busiest, not the last to answer"),
            property<&ThreadScope::span>("span", "s", "of which the worst cycles are kept", range(1, 604800)),
            property<&ThreadScope::before>("before", "s", "kept before the release of a worst cycle",
                                           range(0, 0.05)),
            property<&ThreadScope::after>("after", "s", "kept after its end", range(0, 0.02)),
            operation<&ThreadScope::forget>("forget", "empties what is kept"));
    }

private:
    struct Window {
        std::uint64_t at = 0; ///< on a tape
        std::uint64_t after = 0;
        [[nodiscard]] std::size_t words() const noexcept { return static_cast<std::size_t>(after - at); }
    };
    void turn_tapes() noexcept;
    void empty() noexcept;
    void look(std::uint32_t activity, std::uint32_t rank, std::int64_t until) noexcept;
    void consider(std::uint32_t activity, std::uint32_t rank, const TapeCycle& cycle) noexcept;
    void record(scope::Recording& into, std::uint32_t activity, const TapeCycle& cycle) noexcept;
    [[nodiscard]] Window window(std::uint32_t activity, std::int64_t from, std::int64_t to) const noexcept;
    [[nodiscard]] std::size_t words_between(std::int64_t from, std::int64_t to) const noexcept;

    scope::Directory* directory_ = nullptr;
    os::Clock* clock_ = nullptr;
    bool was_on_ = true;
    bool forgets_ = false;
    Duration span_used_{};
    bool by_busy_used_ = false;
};

} // namespace tappet
