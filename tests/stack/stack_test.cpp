// The stacks of the loom's activities: the need of its firmware's object code against the table's rows.
#include "kernel/machine/firmware.hpp"
#include "kernel/os/memory.hpp"
#include "tests/stack/bounds.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace tappet::carpet {
AcceptedMachine on_host();
}

namespace tappet::stack_bound {
namespace {

/// The framework's design: the calls through pointers. An engine calls its components' functions, they reach
/// primitives, rows and devices, and these wake a thread.
// clang-format off
const Rules rules{
    .layers = {
        {"libmodbus' own transports", {"_modbus_tcp_"}},
        {"waking", {"os::Waiter::", "wake_chain", "EventWaitState::wake"}},
        {"a restart, which blocks", {"can::SocketCan::restart"}, 1, "describe<tappet::can::Restarter"},
        {"ports, properties, filters, devices and signs of life",
         {"PortAccess::", "tappet::Output<", "tappet::Input<", "limits_detail::", "can::SocketCan::", "can::ControlledDevice::", "can::Device::", "gpio::Lines::", "gpio::PlannedLines::", "modbus::LibmodbusTransport::", "detail::MemberOf",
          "detail::PropertyAccess", "detail::BagMember", "detail::command_call_of", "::interface()::{lambda", "detail::Several<", "::add_line<",
          "::unsent(", "::cycles_of(", "::rests(", "::is_part_expected(", "::is_engine_expected("}},
        {"posting; values as texts",
         {"detail::post<", "EventWaitState::receive", "(anonymous namespace)::ValueReader::", "(anonymous namespace)::ValueWriter::",
          "(anonymous namespace)::Reader::", "(anonymous namespace)::Writer::"}},
        // A synchronous reaction of a component may emit an event that another one of the activity receives
        // at once.
        {"operations, methods and guards",
         {"OperationCall<", "detail::MethodOf", "MethodCall<", "detail::CommandOf", "statechart::call", "detail::TimerCall", "note_transition",
          "MachineBuilder::place_engines"},
         2},
        {"emitting", {"tappet::Event<"}},
        {"instructions", {"tappet::primitive::", "test_condition", "run_program", "program_wakes"}},
        {"executions", {"StateMachineExecution::", "ProgramExecution::", "native::"}},
        {"between two steps",
         {"AsyncReaction::serve", "::run_operation(", "::run_method(", "::force_port(", "::release_port(", "::command_behaviour(", "::ask_guards(",
          "PropertyTransaction::", "BehaviourSlot::obey", "EngineCall::run", "MethodRequest::run", "run_trigger",
          "run_observer", "BrowserService::observe", "MachineBuilder::place_unit", "MachineBuilder::place_slot"}},
        // For a component that decides itself when it runs; the loom has none, and a layer that is never
        // entered needs nothing.
        {"an engine's cycle out of a loop", {"tappet::Activity::loop("}, 1, "nobody"},
        {"requests of browsers", {"BrowserService::look_at_", "PropertyFiles::store"}, 1, "describe<tappet::BrowserService"},
        {"requests as they come", {"BrowserService::serve_"}, 1, "describe<tappet::BrowserService"},
        {"functions of components' lives", {"detail::describe<"}},
    },
    .ends = {"contract_broken", "break_contract", "__assert_fail", "__stack_chk_fail", "abort", "__libc_message", "std::terminate",
             "__throw_", "__cxa_", "_Unwind_", "__libc_fatal", "pthread_exit"},
    // The main thread calls these: arming, opening devices, the end; so does the guardian.
    .outside = {"::analyse_traffic(", "::longest_seen(", "::gate_output(", "MachineBuilder::construct()::", "os::(anonymous namespace)::", "ExtraSections<", "ExtraList::", "ExtraSection::", "Limits<", "Control<", "RealWorld::", "MakersThread::", "Activity::enter(", "MachineInstance",
                "tappet::Hardware<", "tappet::OpenedDevices::", "::RealBus::", "::RealChip::", "::RealServer::", "::RealPort::", "tappet::RealDevice::", "tappet::DeviceAsked const&", "os::Guard::try_apart<", "tappet::make_safe_requests(", "::GuardedProcess::", "tappet::end_safely(", "BrowserService::answer_for_nobody", "run_firmware(", "Probe::wake(", "Probe::load(", "os::build_id()", "cpf::is_blank"},
    .stated = {
        {picked_at_start, 256, "bytes copied or compared: libc picks the function for the processor, none has a frame to speak of"},
        {"tappet::compile_loaded(", script_stack_bytes, "as tests/kernel/script measures it on hostile texts; the table's check asks for it"},
        {"__clock_gettime", 1024, "the kernel's vdso, which has no stack of its own"},
        {"strerror", 2048, "texts of the C locale: nobody sets another, so no catalogue is read"},
        {"gai_strerror", 0, "a server has a numeric address: toolchain/libmodbus leaves getaddrinfo out"},
        {"_error_print", 0, "libmodbus tells its errors only when its debugging is on"},
        {"_IO_printf", 0, "libmodbus tells what it does only when its debugging is on"},
        {"_IO_puts", 0, "the same"},
        {"_IO_putchar", 0, "the same"},
        {"__fprintf", 0, "the same"},
    },
    .recurring = {
        {"tappet::(anonymous namespace)::ValueReader::read(", 4, "a value in a value: lists of records"},
        {"tappet::(anonymous namespace)::ValueWriter::write(", 4, "the same"},
        {"tappet::(anonymous namespace)::Reader::read_members(", 4, "bags in bags"},
        {"tappet::(anonymous namespace)::Writer::write_members(", 4, "the same"},
    },
};
// clang-format on

/// libc's own share of a thread, between the top of its stack and Activity::enter: measured 3548 bytes.
constexpr std::size_t above_the_body = 4096;

TEST(Stacks, are_large_enough_for_the_firmware) {
    const Image image = read_image(LOOM_FIRMWARE);
    ASSERT_FALSE(image.functions.empty())
        << "the firmware or objdump is not there; ci/setup installs the latter";
    const AcceptedMachine machine = carpet::on_host(); // of the same table: a board changes no stack
    Bounds bounds{image, rules};
    for (std::size_t a = 0; a < machine.table.activities.size(); ++a) {
        std::vector<std::string> owned;
        for (std::size_t c = 0; c < machine.table.components.size(); ++c)
            if (machine.index.activity[c] == a)
                owned.push_back("describe<" + std::string{machine.table.components[c].type->tag->name});
        const Names allowed{owned.begin(), owned.end()};
        const std::size_t bound = bounds.of("tappet::Activity::enter(void*)", allowed);
        std::cout << machine.table.activities[a].name << ": " << bound << " of "
                  << machine.plan.activities[a].stack_bytes << " bytes, the most on this path:\n"
                  << bounds.path();
        const std::size_t stack = machine.plan.activities[a].stack_bytes;
        EXPECT_LE(above_the_body + bound + os::stack_guard_bytes(stack), stack)
            << machine.table.activities[a].name << ", its guard included";
    }
    for (const std::string& fault : bounds.faults()) ADD_FAILURE() << fault;
}

} // namespace
} // namespace tappet::stack_bound
