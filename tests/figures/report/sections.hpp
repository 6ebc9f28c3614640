// Text for the reader about each program of figures, before its numbers.
#pragma once

#include <array>
#include <string_view>

namespace tappet::figures {

struct Section {
    std::string_view program;
    std::string_view title;
    std::string_view about;
};

/// In the page's order; a program without a section follows under its own name.
// clang-format off
inline constexpr std::array sections{
    Section{"reaction", "Reaction: from the stimulus to what it causes",
            "Wake-ups and hand-overs of a machine's activities beside bare programs with the same system calls, in alternation. Equality is claimed "
            "only where an equivalence test on paired samples shows it within the stated margin."},
    Section{"bench", "Reaction on the bench",
            "Frames and edges through a machine on the emulated PC with a PREEMPT_RT kernel, beside a bare program with the same system calls in the same boot."},
    Section{"exchange", "Data and buffers",
            "What the ports of a component cost: a value or a packet from one component to another, in one activity and across two, on one core and on two."},
    Section{"dispatch", "Methods, commands, events and the engine",
            "What it costs to call, to ask and to tell; and what the engine of an activity adds to the components that it runs."},
    Section{"wire", "From machine to machine",
            "What crosses the CAN wire of a system: a value told and heard, an event with its answer, beside a program that packs, protects and sends the same "
            "frames by hand, at a controller of memory."},
    Section{"behaviour", "State machines and programs",
            "Behaviours as C++ tables and as scripts, compiled with the firmware and loaded into the running machine."},
    Section{"motion", "The mathematics of motion",
            "Kinematics, dynamics, their inverses, trajectories and controllers for one cycle of six axes, beside KDL. The sine that is counted is that of "
            "kernel/motion, inlined, in a firmware as here; it stands beside musl's and glibc's in a figure of its own. KDL is given musl's."},
    Section{"experiments", "The validation experiments",
            "Four applications on one processor, from minimal to large, with drifting periods, a background activity and random load, in five "
            "settings: no communication, data through locks, data through Tappet's connectors, commands, events (thesis 4.2.3, 4.4.4, 4.5.4, 4.6.4)."},
    Section{"scope", "Watching: the thread scope", "What recording every function of every activity costs the machine that is watched."},
    Section{"recording", "Reporting: a hundred ports", "What recording values costs the machine that is recorded."},
    Section{"scale", "Scale",
            "Generated machines of growing size: what the compiler takes, what the firmware takes, and what one component costs at run time. And one machine of a "
            "generated system."},
    Section{"firmware", "The firmware of the carpet loom", "Its size, its memory, and the time from its start to an armed machine. The size of a station of the lane, too."},
    Section{"floors", "Floors of this machine",
            "What no framework can beat: copies, single words, hand-overs between cores, wakes and system calls, so that a reader knows the machine."},
};
// clang-format on

} // namespace tappet::figures
