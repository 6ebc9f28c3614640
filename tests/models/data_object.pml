/* The last value of one writer for any number of readers (thesis 4.4.2).
   Source: kernel/exchange/data_object.hpp kernel/exchange/words.hpp
   Twins: NO_MARK MARK_LATE NO_CHECK CHECK_UNCHANGED PUBLISH_EARLY TRY_FOR_EVER

   Shown: no value is torn or mixed with another one's number; a reader never goes backwards; an attempt fails only when
   the writer has begun to write into the same slot again; with the writer at rest, a reader gets the last value; and
   every call ends within its bound of steps.
   A word stands for the unit that the processor moves at once. A larger value has two words, which may come apart. The
   results do not depend on the size of a word, since the number alone decides whether a value of two words is accepted.
   Steps interleave in program order. The processor only lets a load pass an earlier store of the same thread: here the
   writer loads nothing and a reader stores nothing, so there is no such pair. Readers do not interact: one stands for
   all. */

#define SLOTS 2
#define ATTEMPTS 2
#define WORDS 2
#define LAST 5
#define READS 3
#define WRITE_BOUND (WORDS + 3)
#define READ_BOUND (ATTEMPTS * (WORDS + 2))

byte number[SLOTS];
byte words[SLOTS * WORDS];
byte published;
byte begun;          /* of the writer, for the assertions only */
bool writer_rests;

active proctype writer() {
    byte generation, slot, i, steps;
    do
    :: generation < LAST ->
        atomic { generation++; slot = generation % SLOTS; i = 0; steps = 0; begun = generation }
#ifdef TWIN_PUBLISH_EARLY
        published = generation;
#endif
#ifndef TWIN_NO_MARK
#ifndef TWIN_MARK_LATE
data_write_mark:
        atomic { number[slot] = 0; steps++ }
#endif
#endif
        do
        :: i < WORDS ->
words_store:
            atomic { words[slot * WORDS + i] = generation; i++; steps++ }
        :: else -> break
        od;
#ifdef TWIN_MARK_LATE
        number[slot] = 0;
#endif
data_write_number:
        atomic { number[slot] = generation; steps++ }
#ifndef TWIN_PUBLISH_EARLY
data_write_publish:
        atomic { published = generation; steps++ }
#endif
        assert(steps <= WRITE_BOUND)
    :: else -> break
    od;
    writer_rests = true
}

active proctype reader() {
    byte generation, attempt, slot, i, steps, reads, got, check;
    byte copy[WORDS];
    bool rests;
    do
    :: reads <= READS ->
        atomic { reads++; attempt = 0; steps = 0 }
        if
        :: reads > READS -> writer_rests; rests = true
        :: else
        fi;
        do
#ifdef TWIN_TRY_FOR_EVER
        :: true ->
#else
        :: attempt == ATTEMPTS -> assert(!rests); break
        :: else ->
#endif
data_read_index:
            atomic { got = published; steps++ }
            if
            :: got == generation || got == 0 -> break
            :: else
            fi;
            atomic { slot = got % SLOTS; i = 0 }
#ifdef TWIN_CHECK_UNCHANGED
            byte first = number[slot];
#endif
            do
            :: i < WORDS ->
words_load:
                atomic { copy[i] = words[slot * WORDS + i]; i++; steps++ }
            :: else -> break
            od;
data_read_check:
            atomic { check = number[slot]; steps++ }
#ifdef TWIN_NO_CHECK
            check = got;
#endif
#ifdef TWIN_CHECK_UNCHANGED
            if
            :: check == first && check != 0 -> check = got
            :: else -> check = 0
            fi;
#endif
            if
            :: check != got ->
                assert(begun >= got + SLOTS && !rests);
                attempt++;
                assert(steps <= READ_BOUND)
            :: else ->
                assert(copy[0] == got && copy[1] == got);
                assert(got > generation);
                generation = got;
                break
            fi
        od;
        assert(steps <= READ_BOUND);
        assert(!rests || generation == LAST);
        /* A caller distinguishes "overtaken" from "nothing new" by this. */
data_generation:
        atomic { check = published; assert(check >= generation && (attempt < ATTEMPTS || check > generation)) }
    :: else -> break
    od
}
