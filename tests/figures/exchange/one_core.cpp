// Each operation gives one packet and takes it.
#include "tests/figures/exchange/exchange.hpp"

#include "tests/figures/exchange/iceoryx.hpp"
#include "tests/figures/exchange/subjects.hpp"

namespace tappet::figures {

namespace {

template <std::size_t bytes>
Packet<bytes> from{};
template <std::size_t bytes>
Packet<bytes> into{};

template <std::size_t bytes>
struct TwoCopies {
    static constexpr const char* name = "two struct copies";
    static constexpr Standing role = Standing::floor;
    static bool give(const Packet<bytes>& value) noexcept {
        between = value;
        keep(between);
        return true;
    }
    static bool take(Packet<bytes>& target) noexcept {
        target = between;
        return true;
    }

private:
    static inline Packet<bytes> between{};
};

template <std::size_t bytes, class Subject>
void give_and_take(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        keep(from<bytes>);
        bool done = Subject::give(from<bytes>);
        done &= Subject::take(into<bytes>);
        keep(done);
        keep(into<bytes>);
    }
}

template <std::size_t bytes, class... Subjects>
std::vector<Candidate> candidates() {
    return {{Subjects::name, Subjects::role, &give_and_take<bytes, Subjects>}...};
}

template <std::size_t bytes>
void add(std::vector<Group>& groups, bool with_iceoryx) {
    const std::string size = std::to_string(bytes);
    const std::string of = ", " + size + " bytes, one core, warm";
    constexpr std::size_t batch = 64;
    groups.push_back({"exchange.data.local." + size, "data: write and read, same activity" + of, "thesis 4.4",
                      batch, candidates<bytes, Port<bytes, Reach::near>, TwoCopies<bytes>>()});
    if constexpr (bytes == 160)
        groups.back().goals = {
            {"data write + read, same activity, 160 bytes: at most 1.2 x two struct copies",
             Port<bytes, Reach::near>::name,
             1.2,
             {TwoCopies<bytes>::name}}};
    groups.push_back({"exchange.data.across." + size, "data: write and read, across activities" + of,
                      "thesis 4.4", batch,
                      candidates<bytes, Port<bytes, Reach::far>, TwoCopies<bytes>,
                                 LockedValue<bytes, PlainLock>, LockedValue<bytes, InheritingLock>>()});
    if (with_iceoryx) groups.back().candidates.push_back(candidates<bytes, Iceoryx<bytes, false>>().front());
    if constexpr (bytes == 160)
        groups.back().goals = {
            {"data write + read across activities, 160 bytes, one core, warm: at most 3 x two struct copies",
             Port<bytes, Reach::far>::name,
             3,
             {TwoCopies<bytes>::name}}};
    groups.push_back({"exchange.buffer.local." + size, "buffer: push and pop, same activity" + of,
                      "thesis 4.4", batch,
                      candidates<bytes, Buffer<bytes, Reach::near>, TwoCopies<bytes>>()});
    groups.push_back(
        {"exchange.buffer.across." + size, "buffer: push and pop, across activities" + of, "thesis 4.4",
         batch,
         candidates<bytes, Buffer<bytes, Reach::far>, TwoCopies<bytes>, BoostSpsc<bytes>, BoostQueue<bytes>,
                    LockedQueue<bytes, PlainLock>, LockedQueue<bytes, InheritingLock>>()});
    if (with_iceoryx) groups.back().candidates.push_back(candidates<bytes, Iceoryx<bytes, true>>().front());
}

} // namespace

std::vector<Group> one_core_groups(bool with_iceoryx) {
    std::vector<Group> groups;
    add<8>(groups, with_iceoryx);
    add<160>(groups, with_iceoryx);
    add<4096>(groups, with_iceoryx);
    return groups;
}

} // namespace tappet::figures
