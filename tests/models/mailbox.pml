/* Messages into an engine whose thread sleeps when there is nothing to do (thesis 4.2.3, 4.4.4): one ring and one bit for
   each sender, and one word to sleep on.
   Source: kernel/exchange/mailbox.hpp kernel/os/waiter.hpp kernel/os/waiter.cpp
   Twins: BIT_BEFORE_PUSH WAKE_BEFORE_BIT CLEAR_AFTER SLEEP_WITHOUT_LOOKING WAIT_WITHOUT_COMPARING WAKE_BY_STORE

   Shown: no wake is lost: when all threads rest, every message was served, in the order of its sender, and the receiver
   never sleeps for ever with a message in a mailbox; posting and waking end within their bound of steps.
   The ring is the one of ring.pml: here its push, its pop and its fill are one step each. All deciding steps are
   operations that read and write at once, which the processor never reorders. */

#define SENDERS 2
#define MESSAGES 3
#define CAPACITY 2
#define POST_BOUND 4        /* the push, the bit, the look, the wake; plus the operating system's call */

#define IDLE 0
#define WOKEN 1
#define ASLEEP 2

byte pushed[SENDERS], popped[SENDERS];  /* the indices of each ring: message n is the n-th one */
byte pending;                            /* a bit for each sender */
byte state = IDLE;
bool in_kernel;                          /* the receiver sleeps on the word */
byte served, left_over, posted;

inline wake() {
    old = IDLE;
waiter_look:
    atomic { seen = state; steps++ }
    if
    :: seen == WOKEN -> goto awake      /* it consumes that wake after this look, and then looks at the bits */
    :: else
    fi;
#ifdef TWIN_WAKE_BY_STORE
    old = state;
    state = WOKEN;
#else
waiter_wake:
    atomic { old = state; state = WOKEN; steps++ }
#endif
    if
    :: old == ASLEEP ->
        atomic { in_kernel = false }
    :: else
    fi;
awake:
    seen = IDLE
}

active [SENDERS] proctype sender() {
    byte me = _pid, sent, steps, old, seen;
    do
    :: sent < MESSAGES ->
        steps = 0;
        if
        :: pushed[me] - popped[me] == CAPACITY -> posted++          /* refused and counted; the caller continues */
        :: else ->
#ifdef TWIN_BIT_BEFORE_PUSH
            pending = pending | (1 << me);
#endif
#ifdef TWIN_WAKE_BEFORE_BIT
            wake();
#endif
inbox_push:
            atomic { pushed[me] = pushed[me] + 1; steps++ }
#ifndef TWIN_BIT_BEFORE_PUSH
inbox_bit:
            atomic { pending = pending | (1 << me); steps++ }
#endif
#ifndef TWIN_WAKE_BEFORE_BIT
            wake();
#endif
            assert(steps <= POST_BOUND)
        fi;
        sent++
    :: else -> break
    od
}

active proctype receiver() {
    byte waiting, turn, batch, left, old;
    bool woken;
    do
    :: true ->
        /* wait() */
waiter_take:
        atomic { woken = (state == WOKEN); state = IDLE }
        if
        :: woken -> skip
        :: else ->
#ifdef TWIN_SLEEP_WITHOUT_LOOKING
            state = ASLEEP; old = IDLE;
#else
waiter_doze:
            atomic {
                old = state;
                if
                :: state == IDLE -> state = ASLEEP
                :: else
                fi
            }
#endif
            if
            :: old == IDLE ->
                /* The kernel compares the word once more, with its queue locked. */
#ifdef TWIN_WAIT_WITHOUT_COMPARING
                in_kernel = true;
#else
waiter_sleep:
                atomic { in_kernel = (state == ASLEEP) }
#endif
end_asleep:
                !in_kernel
            :: else
            fi;
            atomic { woken = (state == WOKEN); state = IDLE }
        fi;
        /* run() */
inbox_pending:
        if
        :: pending == 0 -> skip
        :: else ->
            atomic { turn = 0; left = 0 }
#ifdef TWIN_CLEAR_AFTER
            waiting = pending;
#else
inbox_take_bits:
            atomic { waiting = pending; pending = 0 }
#endif
            do
            :: turn < SENDERS && waiting != 0 ->
                if
                :: (waiting & (1 << turn)) != 0 ->
                    waiting = waiting & ~(1 << turn);
inbox_size:
                    batch = pushed[turn] - popped[turn];
                    do
                    :: batch > 0 ->
inbox_pop:
                        atomic { popped[turn] = popped[turn] + 1; batch--; served++ }
                    :: else -> break
                    od;
inbox_left:
                    if
                    :: pushed[turn] != popped[turn] -> left = left | (1 << turn)
                    :: else
                    fi
                :: else
                fi;
                turn++
            :: else -> break
            od;
#ifdef TWIN_CLEAR_AFTER
            pending = 0;
#endif
            if
            :: left != 0 ->
inbox_put_back:
                pending = pending | left
            :: else
            fi
        fi
    od
}

/* No thread can continue: all senders are done, and the receiver sleeps. */
active proctype rest() {
    timeout;
    assert(served + posted == SENDERS * MESSAGES);
    assert(pending == 0);
    assert(pushed[0] == popped[0] && pushed[1] == popped[1])
}
