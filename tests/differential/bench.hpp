// The components that generated scripts use: one of each kind of facet, and a diary of everything that
// happens to them. A command with 7 fails, one below zero is rejected.
#pragma once

#include "kernel/component/component.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tappet {

struct Diary {
    std::vector<std::string> lines{};

    void write(const std::string& line) { lines.push_back(line); }
};

/// Progress of a command that takes `goal` cycles.
struct Job {
    std::int64_t left = 0;
    bool fails = false;

    bool begin(std::int64_t goal) noexcept TAPPET_REALTIME {
        if (goal < 0) return false;
        left = goal;
        fails = goal == 7;
        return true;
    }
    CommandProgress progress() noexcept TAPPET_REALTIME {
        if (left > 0) {
            --left;
            return CommandProgress::executing;
        }
        return fails ? CommandProgress::failed : CommandProgress::done;
    }
};

/// A record.
struct Place {
    double x = 0;
    std::int32_t turns = 0;
};
template <> inline constexpr auto fields_of<Place> =
    fields(field<&Place::x>("x"), field<&Place::turns>("turns"));

/// Runs in the same activity as the script's component and its peer.
struct Bench {
    Diary* diary = nullptr;
    const char* name = "";
    Job job{};
    Property<std::int32_t> gain{3};
    Property<double> level{1.5};
    Property<bool> open{false};
    Input<double> measured;
    Output<double> setpoint;
    BufferInput<std::int64_t> queue;
    BufferOutput<double> sent;
    Event<> tick;
    Event<std::int32_t, double> moved;
    Event<bool> switched;

    void log(const std::string& what) { diary->write(name + (" " + what)); }
    std::int64_t note(std::int64_t n) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's diary grows", log("note " + std::to_string(n)));
        return n / 2 + 1;
    }
    double mix(double a, std::int32_t b) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's diary grows", log("mix " + std::to_string(b)));
        return 0.5 * a + static_cast<double>(b);
    }
    bool ask(std::int16_t n) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's diary grows", log("ask " + std::to_string(n)));
        return (n & 1) == 0;
    }
    Place shift(const Place& from, double by) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's diary grows", log("shift " + std::to_string(from.turns)));
        return {from.x + by, from.turns / 2 + 1};
    }
    bool say(const Text<8>& what) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's diary grows", log("say " + std::string{what.view()}));
        return what.length != 3;
    }
    void poke(bool hard) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's diary grows", log(hard ? "poke hard" : "poke"));
    }
    bool work(std::int64_t cycles) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's diary grows", log("work " + std::to_string(cycles)));
        return job.begin(cycles);
    }
    CommandProgress worked(std::int64_t) noexcept TAPPET_REALTIME { return job.progress(); }

    static constexpr auto interface() {
        return facets(
            property<&Bench::gain>("gain", "", "a whole number", range(-50, 50)),
            property<&Bench::level>("level", "", "a real one", range(-1000, 1000)),
            property<&Bench::open>("open", "", "a boolean"),
            input<&Bench::measured>("measured", "", "comes from outside", optional),
            output<&Bench::setpoint>("setpoint", "", "goes there"),
            input<&Bench::queue>("queue", "", "whole numbers, one after the other", optional),
            output<&Bench::sent>("sent", "", "real ones, likewise"),
            method<&Bench::shift>("shift", "a record"), method<&Bench::say>("say", "false of three letters"),
            event<&Bench::tick>("tick", "without arguments"), event<&Bench::moved>("moved", "with two"),
            event<&Bench::switched>("switched", "with one"), method<&Bench::note>("note", "writes it down"),
            method<&Bench::mix>("mix", "of both kinds"), method<&Bench::ask>("ask", "whether it is even"),
            operation<&Bench::poke>("poke", "does nothing"),
            command<&Bench::work, &Bench::worked>("work", "so many cycles"));
    }
};

/// Runs in another activity.
struct Arm {
    Diary* diary = nullptr;
    Job job{};

    bool move(std::int64_t cycles) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's diary grows", diary->write("arm move " + std::to_string(cycles)));
        return job.begin(cycles);
    }
    CommandProgress moved(std::int64_t) noexcept TAPPET_REALTIME { return job.progress(); }
    bool grip(double force, bool hard) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's diary grows", diary->write(hard ? "arm grip hard" : "arm grip"));
        return force >= 0;
    }
    std::int64_t sum(std::int64_t a, std::int32_t b) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's diary grows", diary->write("arm sum " + std::to_string(b)));
        return a / 2 + b;
    }

    static constexpr auto interface() {
        return facets(command<&Arm::move, &Arm::moved>("move", "so many cycles"),
                      command<&Arm::grip>("grip", "done at once"),
                      method<&Arm::sum>("sum", "from any activity", any_thread));
    }
};

} // namespace tappet
