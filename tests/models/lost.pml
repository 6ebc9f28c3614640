/* The count of messages that a ring lost, read by the producer while the consumer works (thesis 4.4.3).
   Source: kernel/exchange/ring.hpp
   Twins: HEAD_FIRST COUNT_FIRST

   Shown: no message counts twice, so the count never exceeds the pushed messages; with the consumer at rest the count is
   exact.
   The consumer's index and its count of skipped messages are read in the order opposite to their stores, so that
   messages between the two stores are missing in the count instead of counting twice. */

#define LAST 5
#define CAPACITY 1

byte tail, head, skipped, popped;
bool consumer_rests;

active proctype producer() {
    byte position, r, s, h, fill, lost;
    bool rest;
    do
    :: position < LAST ->
        atomic { position++; tail = position; rest = consumer_rests }
ring_lost_refused:
        r = 0;
#ifdef TWIN_HEAD_FIRST
        h = head;
        s = skipped;
#else
ring_lost_skipped:
        s = skipped;
ring_lost_head:
        h = head;
#endif
ring_lost_tail:
        fill = tail - h;
        lost = r + s;
        if
        :: fill > CAPACITY -> lost = lost + fill - CAPACITY
        :: else
        fi;
        assert(lost <= position);
        assert(!rest || popped + lost + (fill > CAPACITY -> CAPACITY : fill) == position)
    :: else -> break
    od
}

active proctype consumer() {
    byte position, produced, jump, turns;
    do
    :: turns < 3 ->
        turns++;
        produced = tail;
        if
        :: produced - position > CAPACITY ->
            atomic { jump = produced - CAPACITY - position; position = produced - CAPACITY }
#ifdef TWIN_COUNT_FIRST
            skipped = skipped + jump;
            head = position
#else
            head = position;
            skipped = skipped + jump
#endif
        :: else
        fi;
        if
        :: position < produced -> atomic { position++; head = position; popped++ }
        :: else
        fi
    :: else -> break
    od;
    consumer_rests = true
}
