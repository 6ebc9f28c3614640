// A small machine with a browser service: a ram that moves to its target, and the table that limits it.
#pragma once

#include "kernel/machine/accept.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"
#include "kernel/services/browsing/browser_service.hpp"

#include <unistd.h>

namespace tappet::press {

/// Moves to its target; its interface states the role for each facet.
struct Ram {
    Output<double> place;
    Input<double> limit;
    Event<double> arrived;
    Property<double> speed{1.0};
    Property<double> force{10.0};
    double target = 0;
    std::int64_t strokes = 0;
    int let_goes = 0;
    double limit_at_stop = -1; ///< the limit it read in its stop

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        const double now = place.last();
        const double far = target - now;
        static_cast<void>(limit.get());
        place.write(far > speed ? now + speed : far < -speed ? now - speed : target);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        limit_at_stop = limit.get();
        place.write(0);
    }
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        if (proposal.of(speed) * proposal.of(force) <= 100) return {};
        return Sentence{"speed times force is over 100; lower one of them"};
    }
    bool move_to(double to, std::int64_t&) noexcept TAPPET_REALTIME {
        if (to < 0 || to > limit.get()) return false;
        target = to;
        return true;
    }
    CommandProgress moved_to(double to, std::int64_t& stroke) noexcept TAPPET_REALTIME {
        if (place.last() != to) return CommandProgress::executing;
        stroke = ++strokes;
        arrived.emit(to);
        return CommandProgress::done;
    }
    [[nodiscard]] bool may_hold() const noexcept TAPPET_REALTIME { return false; }
    [[nodiscard]] std::string_view why_not() const noexcept TAPPET_REALTIME { return "too fast"; }
    double distance(double to) noexcept TAPPET_REALTIME { return to - place.last(); }
    void halt() noexcept TAPPET_REALTIME { target = place.last(); }
    void creep() noexcept TAPPET_REALTIME { target += 0.5; }
    void let_go() noexcept TAPPET_REALTIME { ++let_goes; }
    double weigh(double tare) noexcept { return ::usleep(1), 80.0 - tare; }
    double survey() noexcept { return 0.0; }

    static constexpr auto interface() {
        return facets(output<&Ram::place>("place", "mm", "of the ram"),
                      input<&Ram::limit>("limit", "mm", "as far as it may go"),
                      event<&Ram::arrived>("arrived", "it is where it was told to be"),
                      property<&Ram::speed>("speed", "mm/ms", "of the ram", range(0.1, 20)),
                      property<&Ram::force>("force", "kN", "at the bottom", range(0, 100)),
                      command<&Ram::move_to, &Ram::moved_to>("move_to", "goes there",
                                                             for_people(Role::machine_operator, moves)),
                      method<&Ram::distance>("distance", "from here"),
                      operation<&Ram::halt>("halt", "stays", for_people(Role::machine_operator)),
                      operation<&Ram::creep>("creep", "down a little",
                                             for_people(Role::machine_operator, moves_while_held)),
                      operation<&Ram::let_go>("let_go", "opens the clamp"),
                      method<&Ram::weigh>("weigh", "on scales that answer late", may_block, any_thread),
                      method<&Ram::survey>("survey", "all of it", may_block));
    }
};

struct Table {
    Output<double> height;
    BufferOutput<std::int64_t> parts;
    Output<bool> light; ///< never written
    Event<std::array<double, 7>> scanned;
    Event<std::array<double, 80>> pictured;
    void step(const Cycle&) noexcept TAPPET_REALTIME { height.write(50); }
    static constexpr auto interface() {
        return facets(output<&Table::height>("height", "mm", "of the table"),
                      output<&Table::parts>("parts", "", "that lie on it"),
                      output<&Table::light>("light", "", "wanted"),
                      event<&Table::scanned>("scanned", "heights along it"),
                      event<&Table::pictured>("pictured", "heights all over it"));
    }
};

/// Its operations block.
struct Archive {
    int stored = 0;
    Input<double> height; ///< never read
    bool store(double) noexcept { return ::usleep(1), ++stored < 2; }
    std::int64_t count() noexcept { return ::usleep(1), stored; }
    static constexpr auto interface() {
        return facets(command<&Archive::store>("store", "on the disk", may_block),
                      method<&Archive::count>("count", "of what was stored", may_block),
                      input<&Archive::height>("height", "mm", "of the table"));
    }
};

/// Follows its input when something wakes it.
struct Lamp {
    Input<bool> wanted;
    bool lit = false;
    void step(const Cycle&) noexcept TAPPET_REALTIME { lit = wanted.get(); }
    static constexpr auto interface() {
        return facets(input<&Lamp::wanted>("wanted", "", "light", optional));
    }
};

// clang-format off
inline constexpr auto table = machine("press",
    components(component<Ram>("ram", properties_file("ram.cpf", optional)), component<Table>("table"), component<BrowserService>("browser", set("log", false)),
               component<Table>("shelf"), component<Lamp>("lamp"), component<Archive>("archive")),
    activities(
        activity("motion",  every(1ms), budget(50us), runs("ram")),
        activity("slow",    every(10ms), budget(50us), runs("table", "shelf")),
        activity("lamps",   on_work(), at_most(1, 10ms), deadline(10ms), budget(20us), runs("lamp")),
        activity("browser", every(20ms), not_real_time, runs("browser")),
        activity("archive", on_work(), not_real_time, runs("archive"))),
    connections(data("table.height", "ram.limit", stale_after(1s), hold), data("table.light", "lamp.wanted", wakes),
                data("table.height", "archive.height")),
    reactions(), behaviours());
inline constexpr Board board{.name = "test", .world = "host", .memory_budget_bytes = 8 * 1024 * 1024,
                             .browsing = {.mode = 0666, .roles = roles(user(1001, Role::machine_operator), gateway(user(990), up_to(Role::machine_operator)),
                                                            gateway(user(991), up_to(Role::engineer), with_panel))}};
// clang-format on

} // namespace tappet::press
