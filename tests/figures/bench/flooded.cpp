// flooded right|wrong PAIRS FILE: in the guest. A machine runs at one end of a wire, which is flooded by
// turns: measures the time from the release of a loop that is more urgent than the wire to its end, with and
// without flood. Writes a line for each pair of blocks; ends with 1 when the loop was disturbed.
//     right: the loop is more urgent than the wire; wrong: it is less urgent, which this must detect
#include "drivers/can/socket_can.hpp"
#include "drivers/hardware/hardware.hpp"
#include "kernel/base/random.hpp"
#include "kernel/machine/firmware.hpp"
#include "kernel/machine/worlds/real_world.hpp"
#include "tests/drivers/system/flood.hpp"
#include "tests/figures/measure/samples.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::flood {

namespace {

constinit os::Clock machine_clock{os::Clock::Kind::real};

constexpr Board board{.name = "bench",
                      .world = "bench",
                      .memory_budget_bytes = 4 * 1024 * 1024,
                      .processors = 1,
                      .highest_priority = 80,
                      .devices = board_devices(board_device("can0", "can", "can0", bit_rate(500'000))),
                      .only_warned = warn_only("clock-source", "cpu-governor", "heap-sealed")};
constexpr Binding bound = binding(wired("wire", "can0"));

int fail(const char* what) {
    std::printf("flooded: %s\n", what);
    return 2;
}

// ---- measurements of the loop

constexpr auto block_time = 50ms;
constexpr std::size_t in_block = 2 * static_cast<std::size_t>(block_time / loop_period);
struct Block {
    std::array<std::int64_t, in_block> response_ns{};
    std::size_t count = 0;
};
std::atomic<Block*> watched{nullptr};
void look(const Cycle& cycle) noexcept TAPPET_REALTIME {
    Block* const block = watched.load(std::memory_order_acquire);
    if (block == nullptr || block->count == in_block) return;
    block->response_ns[block->count++] = (machine_clock.now() - cycle.release).count();
}

// ---- the flood

enum class Kind : std::uint8_t { none, at_its_rate, of_the_other, of_ours, of_any };
constexpr std::array kinds{Kind::at_its_rate, Kind::of_the_other, Kind::of_ours, Kind::of_any};
constexpr const char* name_of(Kind kind) {
    constexpr std::array names{"quiet", "at_its_rate", "of_the_other", "of_ours", "of_any"};
    return names[static_cast<std::size_t>(kind)];
}
std::atomic<Kind> wanted{Kind::none};
std::atomic<bool> ends{false};
std::atomic<std::uint64_t> sent{0};
constexpr Duration frame_time = 222us; // of 8 bytes without any stuffing

template <const auto& system>
void flood(int socket) {
    constexpr auto& plan = systems::plan_of<system>;
    Random random{1};
    for (std::size_t n = 0; !ends; ++n) {
        const Kind kind = wanted;
        if (kind == Kind::none) {
            usleep(500);
            continue;
        }
        can_frame frame{};
        const WireFrame& as = plan.frames[n % plan.frames.size()];
        if (kind == Kind::of_any) {
            frame.can_id = static_cast<canid_t>(random.below(0x800));
            frame.can_dlc = 8;
        } else {
            if (as.node != (kind == Kind::of_ours ? 0u : 1u)) continue;
            const can::Frame made = frame_of(as, random.next(), static_cast<std::uint8_t>(n % 15));
            frame.can_id = made.id;
            frame.can_dlc = made.length;
            std::copy_n(made.data.begin(), made.length, frame.data);
        }
        if (write(socket, &frame, sizeof frame) == sizeof frame) sent.fetch_add(1);
        if (kind == Kind::at_its_rate) usleep(static_cast<useconds_t>(frame_time / 1us));
    }
}
int open_flood() {
    const int made = socket(PF_CAN, SOCK_RAW, CAN_RAW);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex("can0"));
    // It receives nothing. The interface of sockaddr is C's: one type stands for all.
    if (made < 0 || setsockopt(made, SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0) != 0 ||
        bind(made, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        return -1;
    return made;
}

// ---- the rounds

struct Pair {
    Kind kind{};
    Block quiet{}, flooded{};
};
void add(figures::Samples& all_us, const Block& block) {
    for (std::size_t i = 0; i < block.count; ++i)
        all_us.add(static_cast<double>(block.response_ns[i]) / 1000);
}

/// Judges one kind of flood. Returns true when the loop was not disturbed.
bool judge(Kind kind, const std::vector<Pair>& pairs, std::uint64_t misses, std::uint64_t frames) {
    figures::Samples quiet, flooded;
    for (const Pair& pair : pairs)
        if (pair.kind == kind) add(quiet, pair.quiet), add(flooded, pair.flooded);
    const double q99 = quiet.quantile(0.99), f99 = flooded.quantile(0.99);
    const bool well = misses == 0 && !flooded.empty() && f99 <= 2 * q99;
    std::printf("%s: %zu cycles each, %llu frames; from release to end in us, quiet and flooded: median %.1f "
                "%.1f, p99 %.1f %.1f, most %.1f %.1f; deadlines missed %llu; undisturbed: %s\n",
                name_of(kind), flooded.count(), static_cast<unsigned long long>(frames), quiet.median(),
                flooded.median(), q99, f99, quiet.max(), flooded.max(),
                static_cast<unsigned long long>(misses), well ? "yes" : "no");
    return well;
}
int write_pairs(const char* path, const std::vector<Pair>& pairs) {
    std::FILE* file = std::fopen(path, "w");
    if (file == nullptr) return fail("its file cannot be written");
    for (const Pair& pair : pairs)
        for (const auto& [word, block] : {std::pair{"flooded", &pair.flooded}, {"quiet", &pair.quiet}}) {
            std::fprintf(file, "%s %s", name_of(pair.kind), word);
            for (std::size_t i = 0; i < block->count; ++i)
                std::fprintf(file, " %lld", static_cast<long long>(block->response_ns[i]));
            std::fprintf(file, "\n");
        }
    return std::fclose(file) == 0 ? 0 : fail("its file cannot be written");
}

template <const auto& system>
struct Node {
    static constexpr auto machine_table = station<system, "a", table>;
};

template <const auto& system>
int run(std::size_t pairs_of_each, const char* path) {
    static constexpr auto& rows = Node<system>::machine_table;
    static Hardware<rows> hardware;
    using Made = Firmware<rows, board, bound>;
    if (const auto opened = hardware.open(Made::machine()); !opened) return fail(opened.error().characters);
    static MachineInstance instance{Made::machine(), machine_clock};
    if (const auto configured = instance.configure(hardware.provided()); !configured)
        return fail(configured.error().characters);
    instance.template find<Loop>("loop")->look = &look;
    const Engine *loop = nullptr, *wire = nullptr;
    for (const Engine& engine : instance.engines()) {
        if (engine.name() == "loop") loop = &engine;
        if (engine.name() == "wire") wire = &engine;
    }
    const int socket = open_flood();
    if (socket < 0) return fail("there is no CAN socket to flood from");
    std::vector<Pair> pairs(pairs_of_each * kinds.size());
    std::thread flooder{[socket] { flood<system>(socket); }};

    static RealWorld world{instance};
    static os::ArmingReport report{{board.only_warned.begin(), board.only_warned.end()}};
    const auto armed = world.arm(report, 2);
    if (!armed) return fail("the machine could not be armed");
    if (!world.start(*armed)) return fail(world.refusal().characters);
    sched_param parameters{};
    parameters.sched_priority = 1; // above the flood, below the machine
    sched_setscheduler(0, SCHED_FIFO, &parameters);

    const auto watch = [](Kind kind, Block& block) {
        wanted = kind;
        usleep(5000);
        watched = &block;
        usleep(static_cast<useconds_t>(block_time / 1us));
        watched = nullptr;
    };
    bool well = true;
    watch(Kind::none, pairs.front().quiet); // warm-up
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        const EngineStatistics before = loop->statistics(), before_of_wire = wire->statistics();
        const std::uint64_t frames = sent;
        for (std::size_t i = 0; i < pairs_of_each; ++i) {
            Pair& pair = pairs[k * pairs_of_each + i];
            pair = {.kind = kinds[k]};
            if (i % 2 == 0) watch(Kind::none, pair.quiet);
            watch(kinds[k], pair.flooded);
            if (i % 2 != 0) watch(Kind::none, pair.quiet);
        }
        wanted = Kind::none;
        well = judge(kinds[k], pairs, loop->statistics().misses - before.misses, sent - frames) && well;
        const EngineStatistics& now = wire->statistics();
        std::printf("%s: the wire's activity: %llu cycles, %llu woken too often, %llu over its claim, %llu "
                    "deadlines missed\n",
                    name_of(kinds[k]), static_cast<unsigned long long>(now.cycles - before_of_wire.cycles),
                    static_cast<unsigned long long>(now.wakes_too_many - before_of_wire.wakes_too_many),
                    static_cast<unsigned long long>(now.over_claim - before_of_wire.over_claim),
                    static_cast<unsigned long long>(now.misses - before_of_wire.misses));
    }
    ends = true;
    flooder.join();
    const int hung = world.stop();
    if (hung != 0) return fail("a thread of the machine hung");
    if (const int written = write_pairs(path, pairs); written != 0) return written;
    std::printf("the loop was undisturbed: %s\n", well ? "yes" : "no");
    return well ? 0 : 1;
}

} // namespace

} // namespace tappet::flood

int main(int count, char** words) {
    using namespace tappet::flood;
    const std::string_view which = count == 4 ? words[1] : "";
    const std::size_t pairs = count == 4 ? std::strtoul(words[2], nullptr, 10) : 0;
    if ((which != "right" && which != "wrong") || pairs == 0) {
        std::printf("usage: flooded right|wrong PAIRS FILE\n");
        return 2;
    }
    return which == "right" ? run<right>(pairs, words[3]) : run<wrong>(pairs, words[3]);
}
