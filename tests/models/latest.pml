/* The newest message of one thread to another, three places for it, and a notice in the mailbox (thesis 4.6.2: save only
   the last event data).
   Source: kernel/exchange/latest_message.hpp
   Twins: TWO_PLACES EXCHANGE_IN_TWO NOTICE_ALWAYS NOTICE_NEVER_AGAIN

   Shown: no message is torn; the receiver never gets an older one than before; at rest it has received the newest, so no
   notice is missing; at most one notice is in flight; and both calls end within their bound of steps.
   Both sides meet in one operation that reads and writes at once, which the processor never reorders. */

#define WORDS 2
#define LAST 6
#define FRESH 4
#define PUT_BOUND (WORDS + 2)
#define TAKE_BOUND (WORDS + 1)

byte words[3 * WORDS];
byte middle = 1;
byte notices;
bool sender_rests;

active proctype sender() {
    byte number, back, was, i, steps;
    do
    :: number < LAST ->
        atomic { number++; i = 0; steps = 0 }
        do
        :: i < WORDS -> atomic { words[back * WORDS + i] = number; i++; steps++ }
        :: else -> break
        od;
#ifdef TWIN_EXCHANGE_IN_TWO
        was = middle;
        middle = back | FRESH;
#else
latest_put:
        atomic { was = middle; middle = back | FRESH; steps++ }
#endif
        back = was & 3;
        if
#ifdef TWIN_NOTICE_ALWAYS
        :: true ->
#else
#ifdef TWIN_NOTICE_NEVER_AGAIN
        :: number == 1 ->
#else
        :: (was & FRESH) == 0 ->
#endif
#endif
            atomic { assert(notices == 0); notices++; steps++ }
        :: else
        fi;
        assert(steps <= PUT_BOUND)
    :: else -> break
    od;
    sender_rests = true
}

active proctype receiver() {
    byte front, was, i, steps, last;
    byte copy[WORDS];
#ifdef TWIN_TWO_PLACES
    front = 1;
#else
    front = 2;
#endif
    do
    :: notices > 0 ->
        atomic { notices--; i = 0; steps = 0 }
latest_take:
        atomic { was = middle; middle = front; front = was & 3; steps++ }
        assert((was & FRESH) != 0);
        do
        :: i < WORDS -> atomic { copy[i] = words[front * WORDS + i]; i++; steps++ }
        :: else -> break
        od;
        assert(copy[0] == copy[1] && copy[0] > last);
        assert(steps <= TAKE_BOUND);
        last = copy[0]
    :: atomic { sender_rests && notices == 0 -> break }
    od;
    assert(last == LAST)
}
