// A twin of the kernel's line requests, with the same debounce, numbering and losses.
#include "drivers/gpio/twin.hpp"

namespace tappet::gpio {

std::expected<void, Sentence> Twin::open(const Settings& settings) {
    const auto planned = plan(settings);
    if (!planned) return std::unexpected{planned.error()};
    plan_ = *planned;
    lines_ = settings.lines;
    make_safe();
    return {};
}

void Twin::set_listener(Listener ready, void* context) noexcept {
    ready_ = ready;
    context_ = context;
}

EdgeBatch Twin::read_edges(std::span<Edge> edges) noexcept TAPPET_REALTIME {
    belongs_to_.used();
    if (refuses()) return {};
    std::size_t count = 0;
    while (count < edges.size() && edges_.pop(edges[count])) ++count;
    return judge(edges.first(count));
}

Levels Twin::levels() noexcept TAPPET_REALTIME {
    belongs_to_.used();
    if (refuses()) return {};
    const Mask outputs = driven_.load(std::memory_order_relaxed);
    return {.known = true, .mask = inputs_.load(std::memory_order_acquire) | outputs};
}

bool Twin::write(Mask mask, Mask values) noexcept TAPPET_REALTIME {
    belongs_to_.used();
    if (refuses()) return false;
    const Mask chosen = mask & plan_.outputs;
    const Mask before = driven_.load(std::memory_order_relaxed);
    driven_.store((before & ~chosen) | (values & chosen), std::memory_order_release);
    if (chosen != 0) ++count_.writes;
    return true;
}

bool Twin::drive(std::size_t line, bool active, Time at) noexcept TAPPET_REALTIME {
    if (line >= lines_.size() || lines_[line].role != Role::input) return false;
    const LineFaults& faults = faults_[line];
    bool ok = schedule(line, active, at);
    for (std::uint32_t i = 0; i < faults.bounces; ++i) {
        ok = schedule(line, !active, at + faults.bounce_spacing * (2 * i + 1)) && ok;
        ok = schedule(line, active, at + faults.bounce_spacing * (2 * i + 2)) && ok;
    }
    return ok;
}

void Twin::stick(std::size_t line, bool active, Time at) noexcept TAPPET_REALTIME {
    deliver_until(at);
    stuck_ |= Mask{1} << line;
    change_raw(line, active, at);
    deliver_until(at);
}

void Twin::release(std::size_t line, Time at) noexcept TAPPET_REALTIME {
    deliver_until(at);
    stuck_ &= ~(Mask{1} << line);
    change_raw(line, (driven_to_ >> line & 1u) != 0, at);
}

void Twin::change_raw(std::size_t line, bool active, Time at) noexcept TAPPET_REALTIME {
    if (((raw_ >> line & 1u) != 0) == active) return;
    raw_ ^= Mask{1} << line;
    raw_since_[line] = at;
}

bool Twin::schedule(std::size_t line, bool active, Time at) noexcept TAPPET_REALTIME {
    return changes_.push({at, order_++, static_cast<std::uint32_t>(line), active});
}

bool Twin::next_change(Time now, Change& change) noexcept TAPPET_REALTIME {
    std::size_t first = changes_.size();
    for (std::size_t i = 0; i < changes_.size(); ++i) {
        if (changes_[i].at > now) continue;
        const bool sooner =
            first == changes_.size() || changes_[i].at < changes_[first].at ||
            (changes_[i].at == changes_[first].at && changes_[i].order < changes_[first].order);
        if (sooner) first = i;
    }
    if (first == changes_.size()) return false;
    change = changes_[first];
    changes_[first] = changes_[changes_.size() - 1];
    --changes_.used;
    return true;
}

void Twin::deliver_until(Time now) noexcept TAPPET_REALTIME {
    if (is_still() && !arrived_) return;
    Change change;
    while (next_change(now, change)) {
        settle(change.at);
        const Mask bit = Mask{1} << change.line;
        driven_to_ = change.active ? driven_to_ | bit : driven_to_ & ~bit;
        if ((stuck_ & bit) == 0) change_raw(change.line, change.active, change.at);
    }
    settle(now);
    deliver_late(now);
    if (arrived_ && ready_ != nullptr) ready_(context_);
    arrived_ = false;
}

void Twin::settle(Time now) noexcept TAPPET_REALTIME {
    // Edges of different lines are numbered in the order of time, as their interrupts would be.
    for (std::size_t round = 0; round < lines_.size(); ++round) {
        const Mask unsettled = raw_ ^ inputs_.load(std::memory_order_relaxed);
        std::uint32_t next = most_lines;
        Time next_at = never;
        for (std::uint32_t i = 0; i < lines_.size(); ++i) {
            const Time at = raw_since_[i] + lines_[i].debounce;
            if ((unsettled >> i & 1u) == 0 || at > now || at >= next_at) continue;
            next = i;
            next_at = at;
        }
        if (next == most_lines) return;
        commit(next, (raw_ >> next & 1u) != 0, next_at);
    }
}

void Twin::commit(std::uint32_t line, bool active, Time at) noexcept TAPPET_REALTIME {
    const Mask bit = Mask{1} << line;
    const Mask before = inputs_.load(std::memory_order_relaxed);
    inputs_.store(active ? before | bit : before & ~bit, std::memory_order_release);
    ++seqno_;
    LineFaults& faults = faults_[line];
    const bool drawn = random_.one_in(faults.lose_one_in);
    if (faults.lose_next != 0) {
        --faults.lose_next;
        return;
    }
    if (drawn) return;
    const Edge edge{.line = line, .rising = active, .stamp = at, .seqno = seqno_};
    // A delayed edge delays the edges after it: the kernel's queue keeps its order.
    const Time due =
        late_.empty() ? at + faults.delay : std::max(at + faults.delay, late_[late_.size() - 1].due);
    if (due == at || !late_.push({edge, due})) deliver(edge);
}

void Twin::deliver_late(Time now) noexcept TAPPET_REALTIME {
    std::size_t done = 0;
    while (done < late_.size() && late_[done].due <= now) {
        deliver(late_[done].edge);
        ++done;
    }
    for (std::size_t i = done; i < late_.size(); ++i) late_[i - done] = late_[i];
    late_.used -= done;
}

void Twin::deliver(const Edge& edge) noexcept TAPPET_REALTIME {
    if (edges_.push(edge)) arrived_ = true; // a full buffer loses the edge, and the next number shows it
}

} // namespace tappet::gpio
