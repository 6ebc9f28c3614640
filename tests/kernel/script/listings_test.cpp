// The constructs of the thesis' listings run as printed there (thesis 5.1.5, 5.2.4, 5.4).
#include "tests/kernel/script/fixture.hpp"

#include <gmock/gmock.h>

namespace {

using namespace script_test;

TEST(Listing_5_1, a_method_is_invoked_with_a_variable) {
    Played p{R"(
var double newforce = 10.0;
do robot.setParameter("Force", newforce);
)"};
    p.step();
    EXPECT_EQ(p.robot.trace, "Force=10");
    EXPECT_EQ(p.program().status(), ProgramStatus::stopped);
    EXPECT_EQ(p.get<double>("test", "newforce"), 10.0)
        << "its variables are properties of the program (thesis 5.1.6)";
}

TEST(Listing_5_2, a_command_is_sent_and_awaited) {
    Played p{R"(
var double velocity = 12.5;
var double position = 1.250;
var double axis = 3;
do robot.moveAxis(axis, velocity, position);
do note(1);
)"};
    p.robot.steps_to_go = 3;
    p.step();
    EXPECT_EQ(p.robot.trace, "") << "it runs in the commands' turn of the next step";
    p.step();
    EXPECT_EQ(p.robot.trace, "move426");
    EXPECT_EQ(p.program().line(), 5) << "it waits in the line of the command";
    p.steps(2);
    EXPECT_EQ(p.own.trace, "") << "not done yet";
    p.steps(2);
    EXPECT_EQ(p.robot.trace, "move426 end");
    EXPECT_EQ(p.own.trace, "1");
    EXPECT_EQ(p.program().status(), ProgramStatus::stopped);
}

TEST(Listing_5_3, a_while_loop_counts_over_a_method) {
    Played p{R"(
var int i = 0;
while ( i != robot.totalAxes() ) {
    do robot.disableAxis(i);
    set i = i + 1;
}
)",
             100};
    p.step();
    EXPECT_EQ(p.robot.trace, "disable0 disable1 disable2");
    EXPECT_EQ(p.program().status(), ProgramStatus::stopped);
}

// The whole of listing 5.4, with a way to every state, and the two instantiations of 5.5 and 5.6.
constexpr std::string_view listing_5_4 = R"(
StateMachine ChildType {
    param int step = 1
    var int count = 0
    initial state Counting {
        run { set count = count + step; }
        transitions { if count >= 3 then select Counted }
    }
    final state Counted { entry { do note(count); } }
}
StateMachine StateMachineType {
    param double limit
    var int entered = 0
    var int number = 0
    var Position place
    SubStateMachine ChildType childName(2)

    initial state First {
        entry { do childName.activate(); do childName.start(); }
        transitions { if childName.inState("Counted") then select StateName }
    }
    state StateName {
        precondition (limit > 1.0)
        entry {
            // Program syntax
            set entered = entered + 1;
        }
        run { do note(10); }
        exit { do note(11); }
        transitions {
            if (number == 5) then {
                do note(12);
            } select TargetState
        }
        handle { do note(13); }
        transition seen(number, place)
            if (place.x > 2.0) then {
                do note(14);
            } select TargetState
            else {
                do note(15);
            } select OtherState
    }
    state TargetState { transition halt select Last }
    state OtherState { transition halt() select StateName }
    final state Last { }
}
RootStateMachine StateMachineType machineName(limit = 2.5)
)";

TEST(Listing_5_4, states_have_their_programs_and_transitions_their_branches) {
    Played p{listing_5_4};
    StateMachineExecution& m = p.machine("machineName");
    EXPECT_EQ(m.start(p.now()), StateOutcome::taken);
    EXPECT_EQ(p.state("machineName"), "First");
    EXPECT_EQ(p.state("machineName.childName"), "Counting");
    p.steps(3); // 2, 4: counted
    EXPECT_EQ(p.state("machineName.childName"), "Counted");
    EXPECT_EQ(p.state("machineName"), "StateName");
    EXPECT_EQ(p.own.trace, "4 10 13") << "the child's note, then run and handle: the condition does not hold";
    p.own.trace.clear();

    p.event("machineName", "seen", std::int32_t{7}, Position{1.0, 0, 0});
    EXPECT_EQ(p.state("machineName"), "OtherState");
    EXPECT_EQ(p.own.trace, "15 11") << "the guard says no: the else branch, with its own state";
    EXPECT_EQ(p.get<std::int64_t>("machineName", "number"), 7);
    p.event("machineName", "halt");
    EXPECT_EQ(p.state("machineName"), "StateName");
    p.own.trace.clear();
    p.event("machineName", "seen", std::int32_t{5}, Position{3.0, 0, 0});
    EXPECT_EQ(p.own.trace, "14 11");
    EXPECT_EQ(p.state("machineName"), "TargetState");
    EXPECT_EQ(p.get<std::int64_t>("machineName", "entered"), 2);
}

TEST(Listing_5_4, a_precondition_is_evaluated_with_every_transition_into_its_state) {
    Played p{listing_5_4};
    p.set("machineName", "limit", 0.5);
    static_cast<void>(p.machine("machineName").start(p.now()));
    p.steps(5);
    EXPECT_EQ(p.state("machineName"), "First");
    p.set("machineName", "limit", 1.5);
    p.step();
    EXPECT_EQ(p.state("machineName"), "StateName");
}

TEST(Listing_5_5, one_type_has_several_instances_with_arguments_of_their_own) {
    Played p{R"(
StateMachine Counter {
    param int by
    param double scale = 2
    var double sum = 0
    initial state Run { entry { set sum = by * scale; } transition halt select Done }
    final state Done { }
}
RootStateMachine Counter first(3)
RootStateMachine Counter second(scale = 0.5, by = 7)
)"};
    static_cast<void>(p.machine("first").activate(p.now()));
    static_cast<void>(p.machine("second").activate(p.now()));
    EXPECT_EQ(p.get<double>("first", "sum"), 6.0);
    EXPECT_EQ(p.get<double>("second", "sum"), 3.5);
}

// Listings 5.7 and 5.8; Camera and ImageRecognition are peers in another activity.
constexpr std::string_view listing_5_7 = R"(
StateMachine TrackingApplication {
    var position p;
    var double target = 0;
    var bool stopProgram = false;

    initial state Startup {
        entry {
            do far.go();
            do robot.go();
        }
        transitions { select Waiting }
    }
    final state Shutdown {
        entry {
            do far.go();
            do robot.go();
        }
    }
    state Waiting {
        transition startCalibration() select Calibration
        transition moveCamera(target) select Positioning
    }
    // Part 2.
    state Positioning {
        run { do far.moveTo(target); }
        transitions { select Waiting }
    }
    state Calibration {
        run { do far.calibrate(); }
        transitions {
            if far.isCalibrated() then select ReadyForLocalisation
            select Waiting
        }
    }
    state ReadyForLocalisation {
        transition startLocalisation() select LocaliseCar
    }
    state LocaliseCar {
        run {
            while (!stopProgram) {
                do far.fetchImage();
                do robot.processImage();
                if (robot.carLocated()) then
                    do far.moveTo(far.getPosition() + robot.carLocation());
                if stopProgram then return;
            }
        }
        transitions { select ReadyForLocalisation }
    }
}
)";

TEST(Listings_5_7_and_5_8, the_tracking_application_calibrates_positions_and_tracks) {
    Played p{listing_5_7};
    ASSERT_EQ(p.outcome.unit.instances.size(), 1u)
        << "a script without RootStateMachine stands for one instance of its last type";
    const std::string_view m = "TrackingApplication";
    static_cast<void>(p.machine(m).start(p.now()));
    p.steps(6);
    EXPECT_EQ(p.state(m), "Waiting");
    EXPECT_EQ(p.far.trace, "begin end");
    p.far.trace.clear();
    p.event(m, "moveCamera", 4.2);
    EXPECT_EQ(p.state(m), "Positioning");
    p.steps(3);
    EXPECT_EQ(p.far.trace, "to42 end");
    EXPECT_EQ(p.state(m), "Waiting");
    p.event(m, "startCalibration");
    p.steps(3);
    EXPECT_EQ(p.state(m), "ReadyForLocalisation");
    p.event(m, "startLocalisation");
    p.far.trace.clear();
    p.robot.trace.clear();
    p.steps(10);
    EXPECT_EQ(p.state(m), "LocaliseCar");
    EXPECT_THAT(p.far.trace, testing::StartsWith("begin end to105 end begin end"));
    EXPECT_THAT(p.robot.trace, testing::StartsWith("begin end"));
    p.set(m, "stopProgram", true);
    p.steps(5);
    EXPECT_EQ(p.state(m), "ReadyForLocalisation");
    EXPECT_EQ(p.machine(m).request_final(p.now()), StateOutcome::taken);
    p.steps(4);
    EXPECT_EQ(p.state(m), "Shutdown");
}

} // namespace
