/* A queue from one thread to another (thesis 4.4.3) that, when full, refuses the newest message or drops the oldest.
   Source: kernel/exchange/ring.hpp kernel/exchange/words.hpp
   Twins: NO_FULL_CHECK PUBLISH_EARLY RELEASE_EARLY NO_MARK MARK_LATE NO_CHECK NO_SPARE SKIP_UNCOUNTED NO_SKIP TRY_FOR_EVER MARK_AFTER

   Shown: popped messages are whole and in order, and every gap is counted: popped, skipped and remaining messages add up to
   the pushed ones; a full ring that refuses keeps its contents, one that drops never loses the newest; an attempt to pop
   fails only when the producer has come round to the same cell; the high-water mark is the largest fill so far, and never
   too small; the consumer can pop as many messages as size() says; and every call ends within its bound of steps.
   Each side loads the other's index after it stored its own, the only pair of accesses that the processor may reorder.
   So such a load may here return any value that the index had since the last one; reordering can do no more. */

#define WORDS 2
#define ATTEMPTS 3
#ifdef TWIN_NO_SPARE
#define SPARE 0
#else
#define SPARE 2
#endif
#define LAST 6
#define MOST 4       /* cells, of the larger capacity */
#define PUSH_BOUND (WORDS + 7)
#define POP_BOUND (ATTEMPTS * (WORDS + 4) + 1)

byte capacity, cells;
bool drops, ready, producer_rests;
byte number[MOST];
byte words[MOST * WORDS];
byte tail, head, skipped, refused, high_water;
byte begun, popped, most;   /* for the assertions only */

/* Any value that the index had since the last look. */
inline look(mine, index) {
    atomic {
        byte_looked = mine;
        do
        :: byte_looked < index -> byte_looked++
        :: break
        od;
        mine = byte_looked;
        steps++
    }
}

init {
    atomic {
        if
        :: drops = false
        :: drops = true
        fi;
        if
        :: capacity = 1
        :: capacity = 2
        fi;
        if
        :: drops -> cells = capacity + SPARE
        :: else -> cells = capacity
        fi;
        ready = true
    }
}

active proctype producer() {
    byte position, consumed, i, steps, pushes, byte_looked, fill;
    ready;
    do
    :: pushes < LAST ->
        atomic { pushes++; steps = 0; i = 0 }
#ifndef TWIN_NO_FULL_CHECK
        if
        :: !drops && position - consumed == capacity ->
ring_push_look:
            look(consumed, head);
            if
            :: position - consumed == capacity ->
ring_push_refuse:
                atomic { refused++; steps++ }
                assert(steps <= PUSH_BOUND);
                goto next
            :: else
            fi
        :: else
        fi;
#endif
        begun = position + 1;
#ifdef TWIN_PUBLISH_EARLY
        tail = position + 1;
#endif
#ifndef TWIN_NO_MARK
#ifndef TWIN_MARK_LATE
ring_push_mark:
        atomic { number[position % cells] = 0; steps++ }
#endif
#endif
        do
        :: i < WORDS ->
words_store:
            atomic { words[(position % cells) * WORDS + i] = pushes; i++; steps++ }
        :: else -> break
        od;
#ifdef TWIN_MARK_LATE
        number[position % cells] = 0;
#endif
ring_push_number:
        atomic { number[position % cells] = position + 1; steps++; position++ }
#ifdef TWIN_MARK_AFTER
        atomic {
            tail = position;
            if
            :: tail - head > most -> most = tail - head
            :: else
            fi;
            if
            :: most > capacity -> most = capacity
            :: else
            fi;
            steps++
        }
#endif
ring_mark_read:
        atomic { fill = high_water; steps++ }
        if
        :: fill == capacity || position - consumed <= fill -> skip
        :: else ->
ring_mark_look:
            look(consumed, head);
            fill = position - consumed;
            if
            :: fill > capacity -> fill = capacity
            :: else
            fi;
            if
            :: fill > high_water ->
ring_mark_raise:
                atomic { high_water = fill; steps++ }
            :: else
            fi
        fi;
#if !defined(TWIN_PUBLISH_EARLY) && !defined(TWIN_MARK_AFTER)
ring_push_publish:
        atomic {
            tail = position;
            if
            :: tail - head > most -> most = tail - head
            :: else
            fi;
            if
            :: most > capacity -> most = capacity
            :: else
            fi;
            steps++
        }
#endif
        assert(high_water >= most && high_water <= capacity);
        assert(steps <= PUSH_BOUND);
next:
        skip
    :: else -> break
    od;
    producer_rests = true
}

active proctype consumer() {
    byte position, produced, i, steps, attempt, last, check, byte_looked, inside, seen;
    byte copy[WORDS];
    bool rests, taken, more;
    ready;
    more = true;
    do
    :: more ->
        atomic { rests = producer_rests; steps = 0; attempt = 0; i = 0; taken = false; byte_looked = 0 }
        if
        :: !drops ->
            /* A receiver reads size() before it pops: at least that many are there. */
ring_size_head:
            atomic {
                check = head;
                /* A thread never sees an older value of a place than before. */
                if
                :: produced > seen -> seen = produced
                :: else
                fi
            }
ring_size_tail:
            look(seen, tail);
            atomic { inside = seen - check; steps = 0 }
            if
            :: position == produced ->
ring_pop_look:
                atomic {
                    if
                    :: seen > produced -> produced = seen
                    :: else
                    fi
                }
                look(produced, tail);
                if
                :: rests -> produced = tail
                :: else
                fi
            :: else
            fi;
            if
            :: position == produced -> skip
            :: else ->
#ifdef TWIN_RELEASE_EARLY
                head = position + 1;
#endif
                do
                :: i < WORDS ->
words_take:
                    atomic { copy[i] = words[(position % cells) * WORDS + i]; i++; steps++ }
                :: else -> break
                od;
                taken = true;
                assert(copy[0] == copy[1] && copy[0] > last)
            fi;
            assert(inside <= capacity && (taken || inside == 0))
        :: else ->
            do
#ifdef TWIN_TRY_FOR_EVER
            :: taken -> break
            :: else ->
#else
            :: taken || attempt == ATTEMPTS -> break
            :: else ->
#endif
ring_take_look:
                look(produced, tail);
                if
                :: rests -> produced = tail
                :: else
                fi;
                if
                :: position == produced -> break
                :: else
                fi;
#ifndef TWIN_NO_SKIP
                if
                :: produced - position > capacity ->
                    check = produced - capacity - position;
                    position = produced - capacity;
ring_skip_release:
                    atomic { head = position; steps++ }
#ifndef TWIN_SKIP_UNCOUNTED
ring_skip_count:
                    atomic { skipped = skipped + check; steps++ }
#endif
                :: else
                fi;
#endif
                i = 0;
                do
                :: i < WORDS ->
words_load:
                    atomic { copy[i] = words[(position % cells) * WORDS + i]; i++; steps++ }
                :: else -> break
                od;
ring_take_check:
                atomic { check = number[position % cells]; steps++ }
#ifdef TWIN_NO_CHECK
                check = position + 1;
#endif
                if
                :: check != position + 1 ->
                    assert(begun > position + capacity + 2 && !rests);
                    attempt++
                :: else ->
                    assert(copy[0] == position + 1 && copy[1] == position + 1);
                    taken = true
                fi;
                assert(steps <= POP_BOUND)
            od
        fi;
        if
        :: taken ->
            atomic { last = copy[0]; popped++; position++ }
#ifndef TWIN_RELEASE_EARLY
ring_pop_release:
            atomic { head = position; steps++ }
#endif
        :: else ->
            more = !rests
        fi;
        assert(steps <= POP_BOUND)
    :: else -> break
    od;
    /* Both sides rest: the count is exact. */
    assert(tail == head);
    assert(popped + skipped + refused == LAST);
    assert(!drops || (last == LAST && refused == 0));
    assert(drops || skipped == 0)
}
