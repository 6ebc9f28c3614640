/* An asynchronous subscription that is connected and disconnected during emissions (thesis 4.6.2, 4.6.3).
   Source: kernel/component/subscription.hpp kernel/component/event_handle.hpp kernel/component/event.hpp
   Twins: EPOCH_FIRST NO_EPOCH BIT_FIRST NO_CHECK CHECK_BIT_ONLY NO_QUOTA COUNT_LATE

   Shown: an emission begun after disconnect() returned never reaches the reaction; a reaction that begins after
   disconnect() returned never belongs to an emission that found the row connected before, however long its message was in
   the mailbox; no emission to a row that stays connected is dropped; the mailbox never holds more than the row's quota;
   and every call ends within its bound of steps.
   Two threads disconnect, one of them connects again; the emitter and the receiver are two others. Bit and epoch are
   changed by operations that read and write at once, which the processor never reorders; the emitter only loads them, in
   order. */

#define EMISSIONS 3
#define QUOTA 2
#define EMIT_BOUND 6
#define CHANGE_BOUND 2

bool linked = true;
byte epoch;
byte served;                     /* the receiver's count, which the emitter loads */
byte pushed, popped;             /* of the mailbox, which is the one of ring.pml */
byte sent_epoch[QUOTA];          /* content of a message */

/* For the assertions only. */
byte found_at[QUOTA];            /* how many disconnect() had cleared the bit when the row was found connected */
bool sure[QUOTA];                /* emitted to a row that was connected, with nobody disconnecting */
byte begun_at[QUOTA];
byte begun, cleared, returned;   /* disconnect(): how many began, how many cleared the bit, how many returned */
byte latest;                     /* of the disconnects that returned, the last one to clear the bit */
bool firm;                       /* disconnect() returned, without a later connect() */
byte connects;                   /* connect(): how many began */

inline disconnect() {
    atomic { begun++; steps = 0 }
#ifdef TWIN_EPOCH_FIRST
    epoch++;
#endif
disconnect_bit:
    atomic { linked = false; steps++; cleared++; mine = cleared }
#if !defined(TWIN_EPOCH_FIRST) && !defined(TWIN_NO_EPOCH)
disconnect_epoch:
    atomic { epoch++; steps++ }
#endif
    atomic {
        assert(steps <= CHANGE_BOUND);
        returned++;
        if
        :: mine > latest -> latest = mine
        :: else
        fi
    }
}

active proctype changer() {
    byte steps, mine;
    disconnect();
    firm = true;
    atomic { firm = false; connects++; steps = 0 }
connect_bit:
    atomic { linked = true; steps++; assert(steps <= CHANGE_BOUND) }
}

active proctype other() {
    byte steps, mine;
    disconnect()
}

active proctype emitter() {
    byte count, posted, caught, waiting, steps, found, at_begin, known;
    bool was_firm, was_sure, connected;
    do
    :: count < EMISSIONS ->
        atomic { count++; steps = 0; was_firm = firm; known = connects; was_sure = linked && begun == returned; at_begin = begun }
emit_row:
        atomic { connected = linked; found = cleared; steps++ }
        if
        :: !connected -> goto unheard
        :: else
        fi;
#ifdef TWIN_BIT_FIRST
        atomic { connected = linked; found = cleared }
#endif
emit_epoch:
        atomic { caught = epoch; steps++ }
#ifndef TWIN_BIT_FIRST
emit_bit:
        atomic { connected = linked; found = cleared; steps++ }
#endif
        if
        :: !connected -> goto unheard
        :: else
        fi;
        assert(!was_firm || known != connects);
emit_quota:
        atomic { waiting = posted - served; steps++ }
#ifdef TWIN_NO_QUOTA
        waiting = 0;
#endif
        if
        :: waiting >= QUOTA -> skip      /* lost, and counted */
        :: else ->
            atomic {
                assert(pushed - popped < QUOTA);
                sent_epoch[pushed % QUOTA] = caught;
                found_at[pushed % QUOTA] = found;
                sure[pushed % QUOTA] = was_sure;
                begun_at[pushed % QUOTA] = at_begin;
                pushed++;
                posted++;
                steps++
            }
        fi;
        goto counted;
unheard:
        assert(!was_sure || begun != at_begin)
counted:
        atomic { assert(steps <= EMIT_BOUND); steps = 0; caught = 0; waiting = 0; found = 0; known = 0; at_begin = 0 }
    :: else -> break
    od
}

active proctype receiver() {
    byte caught, found, at_begin;
    bool was_sure, current;
end_idle:
    do
    :: pushed != popped ->
        atomic {
            caught = sent_epoch[popped % QUOTA];
            found = found_at[popped % QUOTA];
            was_sure = sure[popped % QUOTA];
            at_begin = begun_at[popped % QUOTA];
#ifndef TWIN_COUNT_LATE
            popped++
#endif
        }
serve_count:
        served++;
#ifdef TWIN_COUNT_LATE
        popped++;
#endif
#ifdef TWIN_NO_CHECK
        current = true;
#else
#ifdef TWIN_CHECK_BIT_ONLY
        current = linked;
        assert(!current || latest <= found);
#else
serve_epoch:
        atomic { current = (caught == epoch); assert(!current || latest <= found) }
#endif
#endif
        if
        :: current -> skip
        :: else -> assert(!was_sure || begun != at_begin)
        fi
#ifdef TWIN_NO_CHECK
        ; assert(latest <= found)
#endif
    od
}
