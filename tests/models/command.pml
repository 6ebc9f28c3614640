/* A command from the sender's object to the receiver's engine and back (thesis 4.5.2): one slot, whose values belong to
   the sender until it is sent, and then to the receiver until the command ends.
   Source: kernel/component/command.hpp
   Twins: SENT_AFTER_POST RESULT_AFTER_STATE RESEND NO_FAIL_AT_STOP NO_REJECT_AT_STOP NO_REJECT_WHEN_ASLEEP

   Shown: the action gets the arguments as they were set; results are read whole, and belong to this call; states come in
   order and neither side overwrites the other's; the mailbox holds at most one message of a slot; when all threads rest,
   the command has ended, even if the receiver's engine was stopped meanwhile; send, polling and each turn of the receiver
   end within their bound of steps.
   The state goes to the receiver by a message through a ring, and back by a store that the sender loads: each side stores
   values and then the state, in an order that the processor keeps. */

#define SENDINGS 2
#define SEND_BOUND 4
#define END_BOUND 2

#define READY 0
#define SENT 1
#define ACCEPTED 2
#define EXECUTING 3
#define REJECTED 4
#define FAILED 5
#define DONE 6
#define IN_FLIGHT(s) (s >= SENT && s <= EXECUTING)

byte state = READY;
byte argument[2], result[2];
bool engine_stopped;       /* as the sender sees it */
byte messages;             /* of this slot, in the mailbox */
bool woken;                /* of the receiver's thread */
bool sender_rests;

active proctype sender() {
    byte number, seen, last, steps;
    bool stopped;
    do
    :: number < SENDINGS ->
        number++;
#ifndef TWIN_RESEND
        /* prepare() */
command_state:
        seen = state;
        assert(!IN_FLIGHT(seen));
#endif
        argument[0] = number;
        argument[1] = number;
        /* send() */
        steps = 0;
command_look:
        atomic { stopped = engine_stopped; steps++ }
        if
        :: stopped ->
command_refuse:
            atomic { state = REJECTED; steps++ }
        :: else ->
#ifdef TWIN_SENT_AFTER_POST
            atomic { messages++; woken = true };
            state = SENT;
#else
command_send:
            atomic { assert(!IN_FLIGHT(state)); state = SENT; steps++ }
            atomic { assert(messages == 0); messages++; steps++ }
            atomic { woken = true; steps++ }
#endif
        fi;
        assert(steps <= SEND_BOUND);
#ifndef TWIN_RESEND
        /* polling */
        last = SENT;
        do
        :: atomic { state != last -> seen = state }
            assert(seen > last || last == SENT);
            if
            :: !IN_FLIGHT(seen) -> break
            :: else -> last = seen
            fi
        :: atomic { !IN_FLIGHT(state) -> seen = state; break }
        od;
        if
        :: seen == DONE -> assert(result[0] == number && result[1] == number)
        :: else
        fi;
        if
        :: true -> skip
        :: true ->
command_reset:
            atomic { assert(!IN_FLIGHT(state)); state = READY }
        fi
#endif
    :: else -> break
    od;
    sender_rests = true
}

/* The receiver's engine, which stops at some time and may start again. */
active proctype receiver() {
    byte got[2];
    byte steps;
    bool at_work, active_now;
    active_now = true;
    do
    :: active_now && messages > 0 ->
        messages--;
        steps = 0;
        got[0] = argument[0];
        got[1] = argument[1];
        assert(got[0] == got[1]);
        if
        :: true ->
command_accept:
            atomic { assert(state == SENT); state = ACCEPTED; steps++; at_work = true }
        :: true ->
command_end:
            atomic { assert(state == SENT); state = REJECTED; steps++ }
        fi;
        assert(steps <= END_BOUND)
    :: active_now && at_work ->
        steps = 0;
        if
        :: state == ACCEPTED ->
command_execute:
            atomic { state = EXECUTING; steps++ }
        :: true ->
#ifdef TWIN_RESULT_AFTER_STATE
            state = DONE;
            result[0] = got[0];
            result[1] = got[1];
#else
            result[0] = got[0];
            result[1] = got[1];
            atomic { assert(state == ACCEPTED || state == EXECUTING); state = DONE; steps++ }
#endif
            at_work = false
        :: true ->
            atomic { assert(state == ACCEPTED || state == EXECUTING); state = FAILED; steps++; at_work = false }
        fi;
        assert(steps <= END_BOUND)
    :: active_now && woken ->
        woken = false                       /* the message that woke it is handled now, or by the stop */
    :: active_now ->
        /* Engine::stop(): first the flag for the sender, then the running command, then the mailbox. */
        active_now = false;
        engine_stopped = true;
#ifndef TWIN_NO_FAIL_AT_STOP
        if
        :: at_work -> atomic { state = FAILED; at_work = false }
        :: else
        fi;
#endif
#ifndef TWIN_NO_REJECT_AT_STOP
        if
        :: messages > 0 -> messages--; state = REJECTED
        :: else
        fi
#endif
#ifndef TWIN_NO_REJECT_WHEN_ASLEEP
    :: !active_now && woken ->
        /* Its thread is woken while it waits for a restart: the sender had looked before the stop. */
        woken = false;
        if
        :: messages > 0 -> messages--; state = REJECTED
        :: else
        fi
#endif
    :: !active_now && sender_rests -> break
    od
}

active proctype rest() {
    timeout;
    assert(sender_rests && !IN_FLIGHT(state) && messages == 0)
}
