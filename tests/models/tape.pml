/* An engine writes each of its cycles onto its tape, over the oldest ones, without synchronization; readers go backwards
   from the last cycle (thesis A.2.1).
   Source: kernel/exchange/word_tape.hpp
   Twins: NO_CHECK CHECK_WITHOUT_ITS_CYCLE HEAD_FIRST

   Shown: each record that a reader accepts is whole and from one cycle, and the reader skips no cycle between two of them,
   however often the engine laps it; each side ends within its bound of steps, whatever the other does.
   A cycle has up to one mark and its summary, which holds the number of marks before it. The engine stores in order, the
   reader loads in order. */

#define ROOM 4
#define MOST 2
#define LAST 7
#define READS 2

byte words[ROOM];
byte head;

active proctype engine() {
    byte number, marks, i, position, steps;
    do
    :: number < LAST ->
        atomic {
            number++;
            i = 0;
            steps = 0;
            if
            :: marks = 0
            :: marks = 1
            fi
        }
#ifdef TWIN_HEAD_FIRST
        head = position + marks + 1;
#endif
        do
        :: i <= marks ->
tape_word:
            atomic {
                words[(position + i) % ROOM] = (i < marks -> number * 4 : number * 4 + 1 + marks);
                i++;
                steps++
            }
        :: else -> break
        od;
        position = position + marks + 1;
tape_head:
        atomic { head = position; steps++ }
        assert(steps <= MOST + 1)
    :: else -> break
    od
}

active proctype reader() {
    byte after, at, marks, summary, mark, now, last, reads, steps;
    do
    :: reads < READS ->
        atomic { reads++; last = 0 }
tape_look:
        after = head;
        do
        :: after == 0 -> break
        :: else ->
            steps = 0;
tape_take:
            atomic {
                summary = words[(after - 1) % ROOM];
                steps++;
                marks = (summary % 4 == 0 -> 1 : summary % 4 - 1)
            }
            if
            :: marks >= after -> break
            :: else
            fi;
            atomic { at = after - 1 - marks; mark = summary }
            if
            :: marks == 1 -> atomic { mark = words[at % ROOM]; steps++ }
            :: else
            fi;
tape_check:
            atomic { now = head; steps++ }
            if
#ifdef TWIN_NO_CHECK
            :: true
#else
#ifdef TWIN_CHECK_WITHOUT_ITS_CYCLE
            :: at + ROOM >= now
#else
            :: at + ROOM >= now + MOST
#endif
            :: else -> break
#endif
            fi;
            assert(summary % 4 != 0 && mark / 4 == summary / 4);
            assert(last == 0 || summary / 4 == last - 1);
            atomic { last = summary / 4; after = at }
            assert(steps <= MOST + 1)
        od
    :: else -> break
    od
}
