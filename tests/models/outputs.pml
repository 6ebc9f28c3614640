/* The processes that may kick the box's watchdog: init, and the guardian of a firmware, each by a latch of its own, while
   a machine's process, its guardian and init's worker crash, hang in the kernel or are killed at any time, and users press
   the button.
   Source: kernel/os/output_latch.hpp kernel/os/watchdog.cpp toolchain/machine/safe_ending.cpp board/box/custody.cpp
   Twins: KILL_TOGETHER HOLD_UNASKED START_UNASKED CODE_HANDED_ON STAND_DOWN_UNASKED WORKER_WITHOUT_END ACT_WITHOUT_END SAY_BEFORE_END DRIVE_WHEN_UNSAFE

   Shown: within a bound, undriven outputs are safe or the box is reset, whatever happens in between; a guardian says "safe"
   only when the outputs are; init kills a guardian only after that; the power goes off only with safe outputs; init waits
   for an unkillable worker only up to a bound.
   Time counts in ticks, and a process may be kept from running for any number of them: then it kicks nothing. Whether
   lines accept a write is free. The reset of the box ends a run: the next boot begins where the model does. */

#define WITHIN 2   /* of the watchdog */
#define ACT 2      /* guardian_acts_within */
#define STOP 1     /* stop_patience */
#define GUARD 3    /* guardian_patience */
#define WORK 2
#define GONE 1     /* gone_patience */
/* A guardian that looks late kicked nothing meanwhile. */
#define UNSAFE_BOUND (WITHIN + ACT + WITHIN)
#define WORKER_BOUND (WORK + WITHIN + GONE + WITHIN)

#define SAFE 0
#define UNKNOWN 1
#define UNSAFE 2

bool off;                    /* power, or the reset */
bool unsafe;                 /* the outputs themselves */
byte unsafe_for;
bool dog_ticks;
byte dog_left;

/* A firmware: one process that prepares, then two. */
#define NONE 0
#define PREPARES 1
#define LIVES 2
#define ENDED 3
#define TOUCHED_NOTHING 2
byte guardian_is = NONE;     /* the process that init started */
byte guardian_code;
bool guardian_has_dog, guardian_hangs;
byte machine_is = NONE;      /* LIVES: it drives the outputs */
byte machine_code;
bool machine_hangs;          /* shows no life */
bool machine_waits;          /* in the kernel: a signal that kills waits, too */
bool ended_well, asked;
bool said_safe;              /* a notice on its way to init */

byte latch, guardian_latch;  /* init's, a guardian's */
byte guardian_left;          /* ticks until which a guardian's latch lets it kick */
bool init_has_dog;
byte patience;               /* of init */
byte worker_is = NONE;
byte worker_for;

#define MAY_KICK (guardian_latch == SAFE || guardian_left > 0)
#define GUARDIAN_RUNS (guardian_is == LIVES && !guardian_hangs)

inline open_by_init() {
    if
    :: latch == SAFE -> init_has_dog = true; dog_ticks = true; dog_left = WITHIN
    :: else
    fi
}

inline drop_machine() {
    if
    :: machine_is == LIVES && !machine_waits -> machine_is = ENDED; machine_code = 9; unsafe = true; machine_hangs = false
    :: else
    fi
}

/* Init reads the notices of the firmware before it reports how that ended. */
inline take_end() {
    if
    :: said_safe -> said_safe = false; latch = SAFE
    :: else
    fi;
    if
#ifdef TWIN_START_UNASKED
    :: guardian_code == TOUCHED_NOTHING -> latch = SAFE
#else
    :: guardian_code == TOUCHED_NOTHING && latch == UNKNOWN -> latch = SAFE
#endif
    :: latch == UNKNOWN && guardian_code != TOUCHED_NOTHING -> latch = UNSAFE
    :: else
    fi;
    guardian_is = NONE
}

active proctype box_init() {
    byte starts;
    bool ending;
    {
    skip;
dog_open:
    atomic { open_by_init() };
    do
    :: atomic { latch == SAFE && init_has_dog -> dog_left = WITHIN }
#ifdef TWIN_START_UNASKED
    :: atomic { guardian_is == NONE && starts < 2 ->
#else
    :: atomic { guardian_is == NONE && starts < 2 && latch == SAFE ->
#endif
        starts++;
dog_hand_over:
        if
        :: latch == SAFE && init_has_dog -> dog_left = WITHIN
        :: else
        fi;
        init_has_dog = false;
latch_drive:
        latch = UNKNOWN;
        ended_well = false; asked = false; guardian_hangs = false; guardian_has_dog = false;
        guardian_code = 0;
        guardian_is = PREPARES }
    :: atomic { said_safe && guardian_is == LIVES ->
latch_say:
        said_safe = false; latch = SAFE }
    :: guardian_is == ENDED ->
        atomic {
            if
            :: guardian_code == TOUCHED_NOTHING ->
latch_untouched:
                skip
            :: else ->
latch_lose:
                skip
            fi;
            take_end();
#ifdef TWIN_HOLD_UNASKED
            init_has_dog = true; dog_ticks = true; dog_left = WITHIN; latch = SAFE
#else
            open_by_init()
#endif
        };
#ifndef TWIN_START_UNASKED
        if
        :: latch == UNSAFE -> goto resets
        :: else
        fi
#endif
    :: guardian_is != ENDED -> break          /* the button, or an orderly shutdown of the box */
    od;

    /* end_everything() */
    if
    :: guardian_is == PREPARES || guardian_is == LIVES ->
init_ask:
        atomic { asked = true; patience = STOP };
        do
        :: atomic { guardian_is == ENDED -> take_end(); break }
        :: patience == 0 && guardian_is != ENDED -> break
        od;
        if
        :: guardian_is == PREPARES || guardian_is == LIVES ->
#ifdef TWIN_KILL_TOGETHER
            atomic { drop_machine(); guardian_is = NONE; latch = SAFE };
#endif
init_kill_machine:
            atomic { drop_machine(); patience = GUARD };
            do
            :: atomic { said_safe -> said_safe = false; latch = SAFE; break }
            :: atomic { guardian_is == ENDED -> take_end(); break }
            :: patience == 0 -> break
            :: guardian_is == NONE -> break
            od
        :: else
        fi
    :: guardian_is == ENDED -> atomic { take_end() }
    :: else
    fi;
    if
    :: latch != SAFE -> goto resets
    :: else
    fi;
init_kill_others:
    atomic { drop_machine(); guardian_is = NONE; assert(!unsafe) };
dog_stand_down:
    atomic { dog_ticks = false; init_has_dog = false };

    /* renew_under_watchdog() */
    atomic { worker_is = LIVES; open_by_init(); patience = WORK };
    do
    :: worker_is == ENDED -> goto switchoff
#ifndef TWIN_WORKER_WITHOUT_END
    :: atomic { patience == 0 -> break }
    :: atomic { worker_is == LIVES && patience > 0 ->
dog_kick:
        dog_left = WITHIN }
#else
    :: atomic { worker_is == LIVES -> dog_left = WITHIN }
#endif
    od;
init_kill_worker:
    atomic { patience = GONE };
    do
    :: worker_is == ENDED -> goto switchoff
    :: atomic { patience == 0 -> break }
    :: atomic { patience > 0 -> dog_left = WITHIN }
    od;

resets:
    skip;
init_await_reset:
    atomic { latch = UNSAFE; patience = WITHIN + 1 };
    patience == 0;
init_reset:
    atomic { off = true; goto done };

switchoff:
    atomic { assert(!unsafe); off = true };
    } unless { off };
done:
    skip
}

/* A firmware's guardian, from the split to its end. */
active proctype guardian() {
    bool has_ended, writes_well;
    {
    do
    :: atomic { GUARDIAN_RUNS && !guardian_has_dog ->
dog_open:
        guardian_has_dog = true; guardian_latch = SAFE; guardian_left = 0; dog_ticks = true; dog_left = WITHIN }
    /* This look sees a life sign. */
    :: atomic { GUARDIAN_RUNS && guardian_has_dog && machine_is != ENDED && !machine_hangs ->
latch_drive:
        guardian_latch = UNKNOWN; guardian_left = 1;
dog_kick:
        dog_left = WITHIN }
    :: atomic { GUARDIAN_RUNS && guardian_has_dog && machine_is == ENDED && ended_well ->
        assert(!unsafe);
        guardian_latch = SAFE; dog_ticks = false; said_safe = true; guardian_code = machine_code };
        goto keeps
    :: atomic { GUARDIAN_RUNS && guardian_has_dog && ((machine_is == ENDED && !ended_well) || machine_hangs) ->
        /* end_safely() */
latch_lose:
        guardian_latch = UNSAFE; guardian_left = ACT };
guardian_kill:
        atomic {
            if
            :: GUARDIAN_RUNS -> drop_machine()
            :: else
            fi };
        do
        :: atomic { GUARDIAN_RUNS && MAY_KICK -> dog_left = WITHIN }
#ifdef TWIN_ACT_WITHOUT_END
        :: atomic { GUARDIAN_RUNS -> dog_left = WITHIN }
#endif
#ifdef TWIN_DRIVE_WHEN_UNSAFE
        :: atomic { GUARDIAN_RUNS -> guardian_latch = UNKNOWN; guardian_left = 1 }
#endif
        :: break
        od;
        has_ended = machine_is == ENDED;        /* looked at before the last write */
guardian_write:
        atomic {
            if
            :: GUARDIAN_RUNS ->
                if
                :: true -> writes_well = true; unsafe = false
                :: true -> writes_well = false
                fi
            :: else -> writes_well = false
            fi };
        atomic {
            if
            :: !GUARDIAN_RUNS                   /* it reports nothing, whatever it did */
#ifdef TWIN_SAY_BEFORE_END
            :: GUARDIAN_RUNS && writes_well ->
#else
            :: GUARDIAN_RUNS && writes_well && has_ended ->
#endif
                assert(machine_is == ENDED && !unsafe);
latch_say:
                guardian_latch = SAFE;
dog_stand_down:
                dog_ticks = false; said_safe = true;
                guardian_code = 9
            :: else ->
#ifdef TWIN_STAND_DOWN_UNASKED
                dog_ticks = false;
#endif
                guardian_latch = UNSAFE; guardian_left = 0;
#ifdef TWIN_CODE_HANDED_ON
                guardian_code = machine_code;
#else
                guardian_code = 9               /* never "touched nothing" */
#endif
            fi };
keeps:                                          /* the black box, which may take long */
        if
        :: atomic { GUARDIAN_RUNS -> guardian_is = ENDED }
        :: guardian_is != LIVES
        fi
    od
    } unless { off }
}

/* The faults and events from outside. */
active proctype world() {
    {
    do
    :: atomic { guardian_is == PREPARES -> guardian_code = TOUCHED_NOTHING; guardian_is = ENDED }
    :: atomic { guardian_is == PREPARES && machine_is != LIVES ->
        machine_is = PREPARES; machine_hangs = false; machine_waits = false; machine_code = 0; guardian_is = LIVES }
    :: atomic { machine_is == PREPARES && guardian_has_dog && GUARDIAN_RUNS -> machine_is = LIVES }  /* armed */
    :: atomic { machine_is == PREPARES && guardian_has_dog -> machine_code = 3; ended_well = true; machine_is = ENDED }
    :: atomic { guardian_is == LIVES -> guardian_code = 9; guardian_is = ENDED }      /* killed */
    :: atomic { guardian_is == LIVES && !guardian_hangs -> guardian_hangs = true }
    :: atomic { machine_is == LIVES && !machine_hangs && asked -> ended_well = true; machine_is = ENDED }
    :: atomic { machine_is == LIVES && !machine_hangs -> machine_is = ENDED; unsafe = true;
        if
        :: machine_code = 9
        :: machine_code = TOUCHED_NOTHING       /* a thread reports that itself */
        fi }
    :: atomic { machine_is == LIVES && !machine_hangs -> machine_hangs = true; unsafe = true }
    :: atomic { machine_is == LIVES && !machine_hangs -> machine_hangs = true; machine_waits = true; unsafe = true }
    :: atomic { machine_is == LIVES && machine_hangs -> machine_is = ENDED; unsafe = true; machine_hangs = false;
        machine_waits = false; machine_code = 9 }  /* its call in the kernel came back, and wrote before that */
    :: atomic { machine_is == LIVES && machine_hangs -> unsafe = true }
    :: atomic { worker_is == LIVES -> worker_is = ENDED }
    od
    } unless { off }
}

active proctype clock() {
    do
    :: atomic { !off ->
        if
        :: dog_ticks && dog_left == 1 -> off = true; unsafe = false
        :: else ->
            if
            :: dog_ticks -> dog_left--
            :: else
            fi;
            if
            :: unsafe -> unsafe_for++
            :: else -> unsafe_for = 0
            fi;
            assert(unsafe_for <= UNSAFE_BOUND);
            if
            :: worker_is == LIVES -> worker_for++
            :: else -> worker_for = 0
            fi;
            assert(worker_for <= WORKER_BOUND);
            if
            :: patience > 0 -> patience--
            :: else
            fi;
            if
            :: guardian_left > 0 -> guardian_left--
            :: else
            fi
        fi }
    :: off -> break
    od
}
