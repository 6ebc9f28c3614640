// The lines of one GPIO chip as a component: its ports, events and operations come from a constexpr line map.
#pragma once

#include "drivers/gpio/device.hpp"
#include "drivers/gpio/line_map.hpp"
#include "kernel/component/component.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <string_view>
#include <utility>

namespace tappet::gpio {

/// The names of a map's facets: "line", "line.rises", "line.falls", "line.set", "line.clear".
template <const auto& map> struct LineNames {
    struct Name {
        std::array<char, 64> letters{};
        std::size_t length = 0;
        [[nodiscard]] constexpr std::string_view view() const noexcept { return {letters.data(), length}; }
    };
    static constexpr auto with(std::string_view ending) {
        std::array<Name, map.rows.size()> names{};
        for (std::size_t i = 0; i < names.size(); ++i) {
            for (const char letter : map.rows[i].line.name) names[i].letters[names[i].length++] = letter;
            for (const char letter : ending) names[i].letters[names[i].length++] = letter;
        }
        return names;
    }
    static constexpr auto rises = with(".rises");
    static constexpr auto falls = with(".falls");
    static constexpr auto set = with(".set");
    static constexpr auto clear = with(".clear");
    static constexpr auto plain = [] {
        std::array<std::string_view, map.rows.size()> names{};
        for (std::size_t i = 0; i < names.size(); ++i) names[i] = map.rows[i].line.name;
        return names;
    }();
};

/// For each sensor: an output with its level and the edge's time, and the events rises and falls with that
/// time. For each lamp: a required input. For each actuator: the required operations set and clear. Lost
/// edges are counted, told, and the levels read anew. Runs in an activity that is on_device. All real-time.
template <const auto& map> struct LinePort {
    static_assert(map.fault.empty(), "the line map is refused: its member `fault` says why");
    static constexpr std::size_t count = map.rows.size();
    static constexpr std::string_view device_kind = "gpio";
    static constexpr std::span<const std::string_view> device_lines() { return LineNames<map>::plain; }
    static constexpr std::size_t edges_per_cycle = 64;

    std::array<Output<bool>, count> level{};
    std::array<Event<Time>, count> rises{};
    std::array<Event<Time>, count> falls{};
    std::array<Input<bool>, count> wanted{};
    Output<std::int64_t> edges_lost{};
    Event<> edges_were_lost{};

    Sentence configure(Setup& setup) {
        device_ = setup.device<Device>();
        waiter_ = setup.waiter;
        if (device_ == nullptr) return setup.no_device();
        if (const int handle = device_->wait_handle(); handle < 0)
            device_->set_listener(&os::Waiter::wake_thunk, waiter_);
        else if (!waiter_->watch(handle))
            return Sentence{"component \"", setup.component,
                            "\": its activity watches too many devices; give it fewer drivers"};
        return {};
    }

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        edges_lost.write(0);
        const Levels now = device_->levels();
        if (!now.known) return;
        for (std::size_t i = 0; i < count; ++i) {
            if (map.rows[i].line.role != Role::input) continue;
            level[i].write(bit(now.mask, i), cycle.now);
            levels_ = with_bit(levels_, i, bit(now.mask, i));
        }
    }

    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const EdgeBatch batch = device_->read_edges(edges_);
        for (std::size_t i = 0; i < batch.count && i < edges_.size(); ++i) take(edges_[i]);
        if (batch.gap.missed != 0) mend(batch.gap, cycle.now);
        if (batch.count == edges_.size()) waiter_->wake();
        write_outputs();
    }

    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        write_outputs();
        static_cast<void>(device_->make_safe());
    }

    template <std::size_t line> void set() noexcept TAPPET_REALTIME {
        static_cast<void>(device_->write(Mask{1} << line, Mask{1} << line));
    }
    template <std::size_t line> void clear() noexcept TAPPET_REALTIME {
        static_cast<void>(device_->write(Mask{1} << line, 0));
    }

    [[nodiscard]] Counters counters() const noexcept { return device_->counters(); }

    static constexpr auto interface() { return list(std::make_index_sequence<count>{}); }

private:
    static constexpr std::size_t facets_of(std::size_t i) noexcept {
        return map.rows[i].line.role == Role::input ? 3 : map.rows[i].driven == Driven::by_port ? 1 : 2;
    }
    static constexpr std::size_t facet_count = [] {
        std::size_t n = 2;
        for (std::size_t i = 0; i < count; ++i) n += facets_of(i);
        return n;
    }();

    template <std::size_t... i> static constexpr auto list(std::index_sequence<i...>) {
        std::array<Facet, facet_count> all{};
        std::size_t n = 0;
        (add_line<i>(all, n), ...);
        all[n++] = output<&LinePort::edges_lost>("edges_lost", "",
                                                 "edges the kernel could not deliver, since start");
        all[n++] = tappet::event<&LinePort::edges_were_lost>("edges_were_lost",
                                                             "edges were lost; the levels were read anew");
        return all;
    }

    template <std::size_t i>
    static constexpr void add_line(std::array<Facet, facet_count>& all, std::size_t& n) {
        using Names = LineNames<map>;
        constexpr std::string_view name = Names::plain[i];
        if constexpr (map.rows[i].line.role == Role::input) {
            all[n++] = {.name = name,
                        .doc = "the line's level",
                        .kind = FacetKind::output,
                        .type = type_id<bool>,
                        .index = i,
                        .at = [](void* c, std::size_t k) noexcept -> void* {
                            return &static_cast<LinePort*>(c)->level[k];
                        },
                        .port = &PortAccess::data<bool>};
            all[n++] = {.name = Names::rises[i].view(),
                        .doc = "the line became active, at that time",
                        .kind = FacetKind::event,
                        .type = type_id<Arguments<Time>>,
                        .index = i,
                        .at = [](void* c, std::size_t k) noexcept -> void* {
                            return &static_cast<LinePort*>(c)->rises[k];
                        },
                        .event = &PortAccess::event<Time>};
            all[n++] = {.name = Names::falls[i].view(),
                        .doc = "the line became inactive, at that time",
                        .kind = FacetKind::event,
                        .type = type_id<Arguments<Time>>,
                        .index = i,
                        .at = [](void* c, std::size_t k) noexcept -> void* {
                            return &static_cast<LinePort*>(c)->falls[k];
                        },
                        .event = &PortAccess::event<Time>};
        } else if constexpr (map.rows[i].driven == Driven::by_port) {
            all[n++] = {.name = name,
                        .doc = "the level wanted",
                        .kind = FacetKind::input,
                        .type = type_id<bool>,
                        .required = true,
                        .index = i,
                        .at = [](void* c, std::size_t k) noexcept -> void* {
                            return &static_cast<LinePort*>(c)->wanted[k];
                        },
                        .port = &PortAccess::data<bool>};
        } else {
            all[n++] = operation<&LinePort::template set<i>>(Names::set[i].view(), "makes the line active",
                                                             required);
            all[n++] = operation<&LinePort::template clear<i>>(Names::clear[i].view(),
                                                               "makes the line inactive", required);
        }
    }

    static constexpr bool bit(Mask mask, std::size_t i) noexcept TAPPET_REALTIME {
        return (mask >> i & 1u) != 0;
    }
    static constexpr Mask with_bit(Mask mask, std::size_t i, bool value) noexcept TAPPET_REALTIME {
        return value ? mask | Mask{1} << i : mask & ~(Mask{1} << i);
    }

    void take(const Edge& edge) noexcept TAPPET_REALTIME {
        if (edge.line >= count) return;
        levels_ = with_bit(levels_, edge.line, edge.rising);
        level[edge.line].write(edge.rising, edge.stamp);
        if (edge.rising)
            rises[edge.line].emit(edge.stamp);
        else
            falls[edge.line].emit(edge.stamp);
    }

    // What the lost edges left behind: a level that differs is an edge whose time is not known better than
    // now.
    void mend(const Gap& gap, Time now) noexcept TAPPET_REALTIME {
        lost_ += gap.missed;
        edges_lost.write(lost_);
        edges_were_lost.emit();
        if (!gap.levels_known) return;
        for (std::size_t i = 0; i < count; ++i)
            if (map.rows[i].line.role == Role::input && bit(gap.levels, i) != bit(levels_, i))
                take({static_cast<std::uint32_t>(i), bit(gap.levels, i), now, 0, 0});
    }

    void write_outputs() noexcept TAPPET_REALTIME {
        Mask mask = 0;
        Mask values = 0;
        for (std::size_t i = 0; i < count; ++i) {
            if (map.rows[i].line.role != Role::output || map.rows[i].driven != Driven::by_port) continue;
            bool value = false;
            if (wanted[i].read(value) != Flow::fresh) continue;
            mask |= Mask{1} << i;
            values = with_bit(values, i, value);
        }
        if (mask != 0) static_cast<void>(device_->write(mask, values));
    }

    std::array<Edge, edges_per_cycle> edges_{};
    Device* device_ = nullptr;
    os::Waiter* waiter_ = nullptr;
    Mask levels_ = 0;
    std::int64_t lost_ = 0;
};

} // namespace tappet::gpio
