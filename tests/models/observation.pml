/* Another process reads an activity's values out of the memory of the machine, which does not notice (thesis 4.8).
   Source: kernel/activity/engine.hpp kernel/activity/engine.cpp kernel/machine/map/view.hpp
   Twins: EVEN_ALL_THE_TIME NO_SECOND_LOOK ODD_IGNORED START_UNGUARDED

   Shown: an accepted observation is whole and from one cycle, whether the activity starts, runs or stops meanwhile; the
   observer gives up after its attempts, so it never waits; and the machine's part is two steps in a cycle, whatever
   observers do.
   The machine stores the generation, the values and the generation again in an order that the processor keeps, and is the
   only writer; the observer only loads, in order. */

#define WORDS 2
#define CYCLES 3
#define ATTEMPTS 3
#define READS 2
#define READ_BOUND (ATTEMPTS * (WORDS + 2))

byte generation;
byte words[WORDS];

/* The first turn is the activity's start, the last one its stop; the others are cycles. */
active proctype engine() {
    byte turn, i, steps;
    do
    :: turn < CYCLES ->
        atomic { turn++; i = 0; steps = 0 }
#ifdef TWIN_START_UNGUARDED
        if
        :: turn == 1 -> goto unguarded
        :: else
        fi;
#endif
#ifndef TWIN_EVEN_ALL_THE_TIME
observe_begin:
        atomic { generation++; steps++ }
#endif
#ifdef TWIN_START_UNGUARDED
unguarded:
#endif
        do
        :: i < WORDS -> atomic { words[i] = turn; i++ }
        :: else -> break
        od;
#ifdef TWIN_START_UNGUARDED
        if
        :: turn == 1 -> goto through
        :: else
        fi;
#endif
observe_end:
        atomic { generation++; steps++ }
#ifdef TWIN_EVEN_ALL_THE_TIME
        generation++;
#endif
#ifdef TWIN_START_UNGUARDED
through:
#endif
        assert(steps <= 2)
    :: else -> break
    od
}

active proctype observer() {
    byte before, after, attempt, i, steps, reads, last;
    byte copy[WORDS];
    do
    :: reads < READS ->
        atomic { reads++; attempt = 0; steps = 0 }
        do
        :: attempt == ATTEMPTS -> break
        :: else ->
            attempt++;
observe_before:
            atomic { before = generation; steps++ }
            if
#ifdef TWIN_ODD_IGNORED
            :: true ->
#else
            :: before % 2 == 0 ->
#endif
                i = 0;
                do
                :: i < WORDS -> atomic { copy[i] = words[i]; i++; steps++ }
                :: else -> break
                od;
observe_after:
                atomic { after = generation; steps++ }
#ifdef TWIN_NO_SECOND_LOOK
                after = before;
#endif
                if
                :: after == before ->
                    assert(copy[0] == copy[1] && copy[0] >= last);
                    last = copy[0];
                    break
                :: else
                fi
#ifndef TWIN_ODD_IGNORED
            :: else
#endif
            fi
        od;
        assert(steps <= READ_BOUND)
    :: else -> break
    od
}
