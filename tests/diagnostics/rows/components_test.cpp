// Components: their rows, their life-cycle functions, and the devices that the board has for them.
#include "drivers/camera/kind.hpp"
#include "drivers/udp/kind.hpp"
#include "kernel/machine/instance/line_functions.hpp"
#include "tests/diagnostics/rows/fault.hpp"
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
using namespace tappet::diagnostics;

// Outside of any namespace: the sentences contain their names.

struct Twin {
    Output<double> one;
    Output<double> other;
    static constexpr auto interface() {
        return facets(output<&Twin::one>("same", "", "of two facets"),
                      output<&Twin::other>("same", "", "of two facets"));
    }
};

struct Mute {
    Output<double> tone;
    static constexpr auto interface() { return facets(output<&Mute::tone>("tone", "Hz", "")); }
};
struct Jumper {
    void jump() noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return facets(operation<&Jumper::jump>("jump", "up", moves)); }
};
struct Unnamed {
    Output<double> tone;
    static constexpr auto interface() { return facets(output<&Unnamed::tone>("", "Hz", "of the horn")); }
};

struct Restarter {
    static constexpr const DeviceKind& device_kind = can::device_kind;
    static constexpr bool shares_device = true;
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
struct Camera {
    static constexpr const DeviceKind& device_kind = udp::device_kind;
    static constexpr int device_map = 0;
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
struct Eye {
    static constexpr const DeviceKind& device_kind = camera::device_kind;
    static constexpr int device_map = 0;
    static constexpr std::array<std::string_view, 1> size{"160 x 120"};
    static constexpr std::span<const std::string_view> device_lines() { return size; }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
struct Trusted {
    static constexpr const DeviceKind& device_kind = can::device_kind;
    static constexpr int device_map = 0;
    Output<bool> connected, level;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(output<&Trusted::level>("level", "", "of a line", as_it_was),
                      output<&Trusted::connected>("connected", "", "somebody answers"));
    }
};
struct Unopened {
    static constexpr const DeviceKind& device_kind = can::device_kind;
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
struct Unsure {
    static constexpr const DeviceKind& device_kind = can::device_kind;
    static constexpr int device_map = 0;
    void stop(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
struct SlowBus {
    static constexpr const DeviceKind& device_kind = can::device_kind;
    static constexpr int device_map = 0;
    static constexpr Sentence analyse(const DeviceUse& use, std::span<TrafficRow>) {
        return Sentence{"no frame comes through at ", can::bus_facts(use.facts).bit_rate,
                        " bit/s; run it faster"};
    }
    static constexpr DeviceTraffic device_traffic{1, &analyse, nullptr};
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
struct Recorder {
    static constexpr bool records_cycles = true;
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

/// The interface that most horns share.
struct Silent {
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
class PrivateHorn : public Silent {
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
};
struct MisspeltHorn : Silent {
    void strat(const Cycle&) noexcept TAPPET_REALTIME {}
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
};
struct UpdatedHorn : Silent {
    void update(const Cycle&) noexcept TAPPET_REALTIME {}
};
struct AnswerlessHorn : Silent {
    void initialise() {}
};
struct ValueHorn {
    Output<bool> stop;
    static constexpr auto interface() { return facets(output<&ValueHorn::stop>("stop", "", "it is silent")); }
};
struct ThrowingHorn : Silent {
    void start(const Cycle&) {}
};
struct CycleChangingHorn : Silent {
    void step(Cycle&) noexcept TAPPET_REALTIME {}
};
struct CyclelessHorn : Silent {
    void stop() noexcept TAPPET_REALTIME {}
};

namespace {

struct Observer {
    static constexpr bool sees_machine = true;
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

struct Interpreter : Observer {
    static constexpr LineFunctions line_functions{};
};

struct Reader {
    void loop(LoopControl&) {}
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

struct ReaderAndWorker {
    void loop(LoopControl&) {}
    void work(const Cycle&) {}
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

constexpr Fault component_faults[] = {
    {"component_twice", [](Table& m) { m.add(component<Tension>("shaft")); },
     R"(loom: component "shaft" appears twice in components(...), rows 2 and 7; rename or remove one)"},
    {"component_name_dotted", [](Table& m) { m.components[1] = component<Shaft>("main.shaft"); },
     R"(loom: component "main.shaft": a component's name is not empty and has no dot; rename it)"},
    {"component_in_no_activity",
     [](Table& m) {
         m.put(activity("logic", on_work(), at_most(4, 10ms), deadline(2ms), budget(80us), runs("weft")));
     },
     R"(loom: component "lamps": no activity runs it; add it to runs(...) of one)"},
    {"component_in_two_activities",
     [](Table& m) { m.put(activity("motion", every(1ms), budget(120us), runs("shaft", "tension", "weft"))); },
     R"(loom: component "weft" is run by activity "motion" and by activity "logic"; keep it in one)"},
    {"component_twice_in_one_activity",
     [](Table& m) {
         m.put(activity("motion", every(1ms), budget(120us), runs("shaft", "tension", "shaft")));
     },
     R"(loom: component "shaft" is run twice by activity "motion"; remove it once)"},
    {"interface_twice", [](Table& m) { m.add(component<Twin>("twin")); },
     R"(loom: component "twin": its interface names "same" twice; rename one in Twin)"},
    {"recorders",
     [](Table& m) {
         m.add(component<Recorder>("scope"));
         m.add(component<Recorder>("second_scope"));
     },
     R"(loom: component "second_scope" records the machine's cycles as "scope" does already; remove one of them)"},
    {"interface_without_text", [](Table& m) { m.add(component<Mute>("horn")); },
     R"(loom: component "horn": its facet "tone" has no description; add one in Mute)"},
    {"interface_without_name", [](Table& m) { m.add(component<Unnamed>("horn")); },
     R"(loom: component "horn": its interface has a facet without a name; name it in Unnamed)"},
    {"interface_moves_for_nobody", [](Table& m) { m.add(component<Jumper>("horn")); },
     R"(loom: component "horn": "jump" is marked `moves` but is not for people; write for_people(Role::.., moves), or remove the mark)"},
};
INSTANTIATE_TEST_SUITE_P(components, Refusal, planted_into(small_loom, component_faults), name_of);

template <class Horn> void blow(Table& m) {
    m.add(component<Horn>("horn"));
    m.add(activity("noise", every(10ms), budget(10us), runs("horn")));
}

constexpr Fault life_faults[] = {
    {"life_in_private", blow<PrivateHorn>,
     R"(loom: component "horn": PrivateHorn::step looks like a life-cycle function but would never run; declare it public as "void step(const Cycle&) noexcept TAPPET_REALTIME", or rename it)"},
    {"life_misspelt", blow<MisspeltHorn>,
     R"(loom: component "horn": MisspeltHorn::strat looks like a life-cycle function but would never run; declare it public as "void start(const Cycle&) noexcept TAPPET_REALTIME", or rename it)"},
    {"life_otherwise_named", blow<UpdatedHorn>,
     R"(loom: component "horn": UpdatedHorn::update looks like a life-cycle function but would never run; declare it public as "void step(const Cycle&) noexcept TAPPET_REALTIME", or rename it)"},
    {"life_that_answers_nothing", blow<AnswerlessHorn>,
     R"~(loom: component "horn": AnswerlessHorn::initialise looks like a life-cycle function but would never run; declare it public as "Sentence initialise()", or rename it)~"},
    {"life_that_is_a_value", blow<ValueHorn>,
     R"(loom: component "horn": ValueHorn::stop looks like a life-cycle function but would never run; declare it public as "void stop(const Cycle&) noexcept TAPPET_REALTIME", or rename it)"},
    {"life_that_may_throw", blow<ThrowingHorn>,
     R"(loom: component "horn": ThrowingHorn::start looks like a life-cycle function but would never run; declare it public as "void start(const Cycle&) noexcept TAPPET_REALTIME", or rename it)"},
    {"life_with_another_cycle", blow<CycleChangingHorn>,
     R"(loom: component "horn": CycleChangingHorn::step looks like a life-cycle function but would never run; declare it public as "void step(const Cycle&) noexcept TAPPET_REALTIME", or rename it)"},
    {"life_without_its_cycle", blow<CyclelessHorn>,
     R"(loom: component "horn": CyclelessHorn::stop looks like a life-cycle function but would never run; declare it public as "void stop(const Cycle&) noexcept TAPPET_REALTIME", or rename it)"},
};
INSTANTIATE_TEST_SUITE_P(life, Refusal, planted_into(small_loom, life_faults), name_of);

constexpr Fault observer_faults[] = {
    {"observer_in_real_time", [](Table& m) { m.add(component<Observer>("browser"), "logic"); },
     R"(loom: component "browser" sees the machine, but its activity "logic" is real-time; run it in an activity that is not_real_time)"},
    {"observers_in_two_activities",
     [](Table& m) {
         m.add(component<Observer>("browser"), "hall");
         m.add(component<Observer>("store"));
         m.add(activity("attic", every(250ms), not_real_time, runs("store")));
     },
     R"(loom: component "store" sees the machine from activity "attic", but "browser" does so from activity "hall"; run both in one activity)"},
};
/// Adds the stack for it.
void compile_lines(Table& m) {
    m.add(component<Interpreter>("interpreter"));
    m.put(activity("hall", every(250ms), not_real_time, stack(256 * 1024), runs("climate", "interpreter")));
}

constexpr Fault interpreter_faults[] = {
    {"interpreter_on_a_small_stack", [](Table& m) { m.add(component<Interpreter>("interpreter"), "hall"); },
     R"(loom: component "interpreter" compiles lines in activity "hall", whose stack of 65536 bytes is under 229376; enlarge its stack(...))"},
    {"interpreter_twice",
     [](Table& m) {
         compile_lines(m);
         m.add(component<Interpreter>("console"), "hall");
     },
     R"(loom: component "console" executes lines as "interpreter" does already; remove one of them)"},
    {"interpreter_of_too_many",
     [](Table& m) {
         compile_lines(m);
         static std::array<std::string, max_line_components> names;
         ActivityRow one = activity("one", every(250ms), not_real_time), other = one;
         other.name = "other";
         for (std::size_t i = 0; i < names.size(); ++i) {
             names[i] = "silent" + std::to_string(i);
             m.add(component<Silent>(names[i].c_str()));
             static_cast<void>((i % 2 == 0 ? one : other).runs.push(names[i]));
         }
         m.add(one);
         m.add(other);
     },
     R"(loom: component "interpreter" executes lines that name at most 128 components, and the machine has 135; leave it out)"},
    {"interpreter_beside_all_activities",
     [](Table& m) {
         compile_lines(m);
         static std::array<std::string, max_activities> names;
         for (std::size_t i = m.activities.size(); i < names.size(); ++i) {
             names[i] = "silent" + std::to_string(i);
             m.add(component<Silent>(names[i].c_str()));
             ActivityRow row = activity("", every(250ms), not_real_time);
             row.name = names[i];
             static_cast<void>(row.runs.push(names[i]));
             m.add(row);
         }
     },
     R"(loom: component "interpreter" needs a mailbox to each engine, but 63 activities use all mailboxes; merge two activities)"},
};
INSTANTIATE_TEST_SUITE_P(interpreters, Refusal, planted_into(small_loom, interpreter_faults), name_of);
INSTANTIATE_TEST_SUITE_P(observers, Refusal, planted_into(small_loom, observer_faults), name_of);

template <class Type> void read(Table& m, const auto&... options) {
    m.add(component<Type>("reader"));
    m.add(activity("reading", options..., runs("reader")));
}

constexpr Fault loop_faults[] = {
    {"loop_and_work", [](Table& m) { read<ReaderAndWorker>(m, on_work(), not_real_time); },
     R"(loom: component "reader" has loop() and also work(); keep one of them)"},
    {"loop_beside_others",
     [](Table& m) {
         m.add(component<Reader>("reader"));
         m.put(activity("hall", on_work(), not_real_time, runs("climate", "reader")));
     },
     R"(loom: activity "hall" runs others beside component "reader", which keeps the thread (it has loop()); run it in an activity of its own)"},
    {"loop_in_a_periodic_activity", [](Table& m) { read<Reader>(m, every(10ms), not_real_time); },
     R"(loom: activity "reading" is periodic but component "reader" decides itself when it runs (it has loop()); run it on_work())"},
    {"loop_in_real_time", [](Table& m) { read<Reader>(m, on_work(), at_most(1, 10ms), budget(10us)); },
     R"(loom: activity "reading" is real-time but component "reader" may block (it has loop()); run it in an activity that is not_real_time)"},
};
INSTANTIATE_TEST_SUITE_P(loops, Refusal, planted_into(small_loom, loop_faults), name_of);

constexpr Fault device_faults[] = {
    {"device_of_no_driver", [](Table& m) { m.put(component<Shaft>("shaft", device("main_encoder"))); },
     R"(loom: component "shaft" drives no device; remove device("main_encoder"))"},
    {"device_unnamed", [](Table& m) { m.put(component<Encoder>("encoder")); },
     R"(loom: component "encoder" drives a can device but its row names none; add device("..."))"},
    {"device_kind", [](Table& m) { m.put(component<Encoder>("encoder", device("panel"))); },
     R"(loom: component "encoder": binding to board "bench", wired("panel"): it drives a can device but "io" is of kind gpio; name another)"},
    {"device_trusted_while_it_stands",
     [](Table& m) { m.put(component<Trusted>("encoder", device("main_encoder"))); },
     R"(loom: component "encoder" is a driver, but its output "connected" has no value for a stopped driver; add while_stopped(false), while_stopped(true) or as_it_was after its description)"},
    {"device_left_as_it_may_be",
     [](Table& m) { m.put(component<Unsure>("encoder", device("main_encoder"))); },
     R"(loom: component "encoder" drives a can device but does not say whether stop() reached it; write bool stopped_safely() const noexcept TAPPET_REALTIME, which returns true if nothing is driven)"},
    {"device_that_nobody_opens",
     [](Table& m) { m.put(component<Unopened>("encoder", device("main_encoder"))); },
     R"(loom: component "encoder" drives a can device but has no device_map, by which start-up opens it; add static constexpr auto device_map, as the kind's classes read it, or shares_device = true if another component drives the device)"},
    {"device_shared_with_nobody",
     [](Table& m) { m.add(component<Restarter>("restarter", device("spare_encoder")), "hall"); },
     R"(loom: component "restarter" shares device "spare_encoder", which no component drives; correct the name)"},
    {"device_shared", [](Table& m) { m.add(component<Encoder>("spare", device("main_encoder")), "field"); },
     R"(loom: component "spare" drives device "main_encoder", as component "encoder" does; a device has one driver)"},
};
INSTANTIATE_TEST_SUITE_P(devices, Refusal, planted_into(small_loom, device_faults), name_of);

/// The faults change this board and this binding.
Table loom_on_an_old_box() {
    Table m = small_loom();
    m.board.name = "old box";
    return m;
}

void rebind(Table& m, const auto& panel) {
    m.binding = binding(wired("main_encoder", "can0"), wired("hall", "192.168.7.2:502"), panel);
}
/// Binds the climate's server to another place.
void rebind_hall(Table& m, std::string_view to, const auto&... options) {
    m.binding = binding(wired("main_encoder", "can0"), wired("hall", to, options...),
                        wired("panel", "io", line("red", 4), line("green", 5)));
}

/// Adds a camera with these words of the board and of the binding.
void look(Table& m, const BoardDevice& camera, const auto&... bound) {
    m.add(component<Eye>("eye", device("hall-camera")), "hall");
    static_cast<void>(m.board.devices.push(camera));
    m.binding.add(wired("hall-camera", "camera0", bound...));
}
constexpr BoardDevice camera_with(const auto&... words) {
    return board_device("camera0", "camera", "/dev/video0", words...);
}

constexpr Fault camera_faults[] = {
    {"camera_of_no_size", [](Table& m) { look(m, camera_with()); },
     R"(loom: component "eye": binding to board "old box", wired("hall-camera"): device "camera0" states no size and rate; add frames(640, 480, 30), columns, rows and frames per second, to the board's row)"},
    {"camera_of_a_size_that_none_has",
     [](Table& m) { look(m, camera_with(frames(161, 120, 25), pixels(camera::Format::yuyv))); },
     R"(loom: component "eye": binding to board "old box", wired("hall-camera"): device "camera0" states frames(161, 120, 25); write 2 to 4096 columns, an even number, as many rows at most, and 1 to 1000 frames per second)"},
    {"camera_of_no_format", [](Table& m) { look(m, camera_with(frames(160, 120, 25))); },
     R"(loom: component "eye": binding to board "old box", wired("hall-camera"): device "camera0" states no form of its pixels; add pixels(camera::Format::yuyv) or pixels(camera::Format::rgb24) to the board's row)"},
    {"camera_of_another_size",
     [](Table& m) { look(m, camera_with(frames(320, 240, 25), pixels(camera::Format::yuyv))); },
     R"(loom: component "eye": binding to board "old box", wired("hall-camera"): device "camera0" gives images of 320 x 240 pixels and the component takes 160 x 120; write the same size in the board's frames(...) and in camera::Sensor<columns, rows>)"},
    {"camera_exposed_for_too_long",
     [](Table& m) {
         look(m, camera_with(frames(160, 120, 25), pixels(camera::Format::rgb24)), exposure(41ms));
     },
     R"(loom: component "eye": binding to board "old box", wired("hall-camera"): exposure(41000us) is less than 100us or longer than a frame at 25 frames per second; write one between)"},
    {"camera_of_a_chip_s_words", [](Table& m) { look(m, camera_with(lines(8))); },
     R"(loom: board "old box", device "camera0": lines(...) is for a gpio device, and this is a camera device; remove it)"},
};
INSTANTIATE_TEST_SUITE_P(cameras, Refusal, planted_into(loom_on_an_old_box, camera_faults), name_of);

/// Adds a row to the board's list of users.
void list(Table& m, const BoardRole& row) { static_cast<void>(m.board.browsing.roles.push(row)); }

constexpr Fault gateway_faults[] = {
    {"gateway_of_root", [](Table& m) { list(m, gateway(user(0), up_to(Role::engineer))); },
     R"(loom: board "old box", gateway(user(0), ..): root may do everything, whatever bounds it; run the gateway as a user of its own, and name that user)"},
    {"gateway_of_the_group_of_root", [](Table& m) { list(m, gateway(group(0), up_to(Role::observer))); },
     R"(loom: board "old box", gateway(group(0), ..): root may do everything, whatever bounds it; run the gateway as a user of its own, and name that user)"},
    {"gateway_without_a_bound", [](Table& m) { list(m, gateway(user(990), up_to(static_cast<Role>(7)))); },
     R"(loom: board "old box", gateway(user(990), ..): up_to(..) states no role; write up_to(Role::observer), up_to(Role::machine_operator) or up_to(Role::engineer))"},
    {"gateway_with_a_role",
     [](Table& m) {
         list(m, user(990, Role::engineer));
         list(m, gateway(user(990), up_to(Role::machine_operator)));
     },
     R"(loom: board "old box", gateway(user(990), ..): roles(..) has another row for it, and a gateway has one bound; remove one of them)"},
};
INSTANTIATE_TEST_SUITE_P(gateways, Refusal, planted_into(loom_on_an_old_box, gateway_faults), name_of);

constexpr Fault board_faults[] = {
    {"line_twice", [](Table& m) { rebind(m, wired("panel", "io", line("red", 4), line("green", 4))); },
     R"(loom: component "lamps": binding to board "old box", wired("panel"): lines "red" and "green" share a name or an offset; correct one)"},
    {"line_unknown", [](Table& m) { rebind(m, wired("panel", "io", line("red", 4), line("greeen", 5))); },
     R"(loom: component "lamps": binding to board "old box", wired("panel"): it has no line "green"; did you mean "greeen"?)"},
    {"line_of_no_driver",
     [](Table& m) { rebind(m, wired("panel", "io", line("red", 4), line("green", 5), line("blue", 6))); },
     R"(loom: component "lamps": binding to board "old box", wired("panel"): line "blue" is not in the component's map; add it there or remove it here)"},
    {"line_beyond_the_chip",
     [](Table& m) { rebind(m, wired("panel", "io", line("red", 4), line("green", 8))); },
     R"(loom: component "lamps": binding to board "old box", wired("panel"): line "green" has offset 8 but device "io" has lines 0 to 7; correct it)"},
    {"board_device_unknown",
     [](Table& m) { rebind(m, wired("panel", "oi", line("red", 4), line("green", 5))); },
     R"(loom: component "lamps": binding to board "old box", wired("panel"): the board has no device "oi"; did you mean "io"?)"},
    {"board_device_kind",
     [](Table& m) { rebind(m, wired("panel", "serial1", line("red", 4), line("green", 5))); },
     R"(loom: component "lamps": binding to board "old box", wired("panel"): it drives a gpio device but "serial1" is of kind serial; name another)"},
    {"server_address", [](Table& m) { rebind_hall(m, "192.168.7.2"); },
     R"(loom: component "climate": binding to board "old box", wired("hall"): the board has no device "192.168.7.2"; write a server's address as 192.168.7.2:502, or add a serial port to the board's devices)"},
    {"address_in_another_spelling",
     [](Table& m) {
         m.binding = binding(wired("main_encoder", "can0"), wired("hall", "192.168.7.2:0502"),
                             wired("panel", "io", line("red", 4), line("green", 5)));
     },
     R"(loom: component "climate": binding to board "old box", wired("hall"): the board has no device "192.168.7.2:0502"; write a server's address as 192.168.7.2:502, or add a serial port to the board's devices)"},
    {"datagram_address",
     [](Table& m) {
         m.add(component<Camera>("camera", device("camera-link")), "hall");
         m.binding.add(wired("camera-link", "5005"));
     },
     R"(loom: component "camera": binding to board "old box", wired("camera-link"): the board has no device "5005"; write the box's address and the port as 192.168.7.1:5005, or 0.0.0.0:5005)"},
    {"device_bound_for_nobody", [](Table& m) { m.binding.add(wired("spare", "serial1")); },
     R"(loom: binding to board "old box", wired("spare"): no component of the machine drives it; correct the name or remove the row)"},
    {"device_bound_twice",
     [](Table& m) {
         m.binding = binding(wired("main_encoder", "can0"), wired("hall", "serial1"),
                             wired("panel", "io", line("red", 4), line("green", 5)),
                             wired("hall", "192.168.7.2:502"));
     },
     R"(loom: binding to board "old box", wired("hall"): wired("hall") has the same name or the same device of the board; correct one)"},
    {"device_under_two_names",
     [](Table& m) {
         m.add(component<Encoder>("spare", device("spare-can")));
         m.put(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                        runs("encoder", "spare")));
         static_cast<void>(m.board.devices.push(board_device("can1", "can", "can0", bit_rate(500'000))));
         m.binding.add(wired("spare-can", "can1"));
     },
     R"(loom: binding to board "old box", wired("spare-can"): wired("main_encoder") has the same name or the same device of the board; correct one)"},
    {"lines_of_a_bus",
     [](Table& m) {
         m.binding = binding(wired("main_encoder", "can0", line("red", 4)), wired("hall", "192.168.7.2:502"),
                             wired("panel", "io", line("red", 4), line("green", 5)));
     },
     R"(loom: component "encoder": binding to board "old box", wired("main_encoder"): line("red") is for a gpio device, and this is a can device; remove it)"},
    {"word_of_another_kind",
     [](Table& m) {
         m.binding = binding(wired("main_encoder", "can0", unit(3)), wired("hall", "192.168.7.2:502"),
                             wired("panel", "io", line("red", 4), line("green", 5)));
     },
     R"(loom: component "encoder": binding to board "old box", wired("main_encoder"): unit(...) is for a modbus device, and this is a can device; remove it)"},
    {"word_twice", [](Table& m) { rebind_hall(m, "192.168.7.2:502", unit(3), unit(4)); },
     R"(loom: component "climate": binding to board "old box", wired("hall"): unit(...) appears twice; remove one)"},
    {"board_word_of_another_kind",
     [](Table& m) { m.board.devices[1] = board_device("io", "gpio", "/dev/gpiochip0", bit_rate(500'000)); },
     R"(loom: board "old box", device "io": bit_rate(...) is for a can device, and this is a gpio device; remove it)"},
    {"board_word_twice",
     [](Table& m) { m.board.devices[1] = board_device("io", "gpio", "/dev/gpiochip0", lines(8), lines(16)); },
     R"(loom: board "old box", device "io": lines(...) appears twice; remove one)"},
    {"server_unit", [](Table& m) { rebind_hall(m, "192.168.7.2:502", unit(300)); },
     R"(loom: component "climate": binding to board "old box", wired("hall"): unit(300) is not a server address; write 1 to 247, over TCP also 255)"},
    {"server_that_may_never_answer", [](Table& m) { rebind_hall(m, "192.168.7.2:502", answer_within(0ms)); },
     R"(loom: component "climate": binding to board "old box", wired("hall"): answer_within is not above 0; write for example answer_within(300ms))"},
    {"server_on_a_serial_line", [](Table& m) { rebind_hall(m, "serial1", serial_line(0, 'E', 1)); },
     R"(loom: component "climate": binding to board "old box", wired("hall"): no serial line has these settings; write for example serial_line(19'200, 'E', 1))"},
    {"line_missing", [](Table& m) { rebind(m, wired("panel", "io", line("red", 4))); },
     R"(loom: component "lamps": binding to board "old box", wired("panel"): it has no line "green"; add line("...", offset) to it)"},
    {"device_missing",
     [](Table& m) { m.binding = binding(wired("panel", "io", line("red", 4), line("green", 5))); },
     R"(loom: component "encoder": the binding to board "old box" has no wired(...) for device "main_encoder"; add wired("...", "a device of the board") to it)"},
    {"binding_too_long", [](Table& m) { m.binding.too_many = true; },
     R"(loom: binding to board "old box": it has more rows than a binding holds: 16 devices, 256 words of them, 64 placements; raise the bound in kernel/machine/table/binding.hpp)"},
    {"proof_unknown", [](Table& m) { m.binding.proof = proven_by("encoder.angel", 100); },
     R"(loom: binding to board "old box", proven_by("encoder.angel"): component "encoder" has no output "angel"; did you mean "angle"?)"},
    {"proof_that_counts_nothing", [](Table& m) { m.binding.proof = proven_by("encoder.angle", 100); },
     R"(loom: binding to board "old box", proven_by("encoder.angle"): it is not an integer output; name one that counts what the machine makes)"},
    {"placement_of_nothing", [](Table& m) { m.binding.placement[0] = place("thunder", 0); },
     R"(loom: binding to board "old box", place("thunder"): the table has no such activity; remove the placement)"},
    {"placement_twice", [](Table& m) { static_cast<void>(m.binding.placement.push(place("hall", 1))); },
     R"(loom: binding to board "old box": place("hall") appears twice; remove one)"},
    {"board_can_bit_rate", [](Table& m) { m.board.devices[0] = board_device("can0", "can", "can0"); },
     R"(loom: component "encoder": binding to board "old box", wired("main_encoder"): device "can0" states no bit rate; add bit_rate(500'000), or what its bus runs at, to the board's row)"},
    {"board_can_data_bit_rate",
     [](Table& m) { m.board.devices[0] = board_device("can0", "can", "can0", bit_rate(500'000, 250'000)); },
     R"(loom: component "encoder": binding to board "old box", wired("main_encoder"): device "can0" has a data phase of 250000 bit/s, slower than its arbitration; write the faster one as the second, bit_rate(500'000, 2'000'000))"},
    {"traffic_too_much",
     [](Table& m) {
         m.add(component<SlowBus>("slow", device("slow-can")));
         m.put(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                        runs("encoder", "slow")));
         static_cast<void>(m.board.devices.push(board_device("can1", "can", "can1", bit_rate(10'000))));
         m.binding.add(wired("slow-can", "can1"));
     },
     R"(loom: component "slow": board "old box", device "can1": no frame comes through at 10000 bit/s; run it faster)"},
    {"board_gpio_lines", [](Table& m) { m.board.devices[1] = board_device("io", "gpio", "/dev/gpiochip0"); },
     R"(loom: component "lamps": binding to board "old box", wired("panel"): device "io" states no number of lines; add lines(32), or how many it has, to the board's row)"},
    {"placement_processor", [](Table& m) { m.binding.placement[0] = place("motion", 2); },
     R"(loom: activity "motion": its binding to board "old box" places it on processor 2 but the board has processors 0 to 1; correct place("motion"))"},
    {"placement_unknown", [](Table& m) { m.binding.placement[0] = place("motoin", 0); },
     R"(loom: binding to board "old box", place("motoin"): the table has no such activity; did you mean "motion"?)"},
};
INSTANTIATE_TEST_SUITE_P(boards, Refusal, planted_into(loom_on_an_old_box, board_faults), name_of);

} // namespace
