// A command: its sending, and the time from its sending to its end.
#include "tests/figures/dispatch/groups.hpp"
#include "tests/figures/dispatch/machine.hpp"
#include "tests/figures/measure/world.hpp"

#include <boost/lockfree/spsc_queue.hpp>

#include <atomic>
#include <deque>
#include <mutex>

namespace tappet::figures {

namespace {

using namespace std::chrono_literals;

template <CommandCall<double> Sender::* command, Measured& (*machine)() = &measured>
void send(std::size_t times) {
    const RunsActivity here{0};
    auto& all = machine().sender;
    for (std::size_t i = 0; i < times; ++i) {
        bool sent = (all[i % senders]->*command).send(1.0);
        keep(sent);
    }
}
/// Executes everything that was sent. The receiver stays marked as woken, as another wake would find it.
void carry_out(std::size_t) {
    measured().far->run(true);
    measured().far->waiter().wake();
}
/// The receiver is not marked as woken: the next sender wakes it.
void carry_out_and_rest(std::size_t) {
    measured().far->run(true);
    static_cast<void>(measured().far->waiter().take());
}
void carry_out_clocked(std::size_t) { measured().clocked->run(false); }

/// The content of a command's message: its command and its receiver.
struct Notice {
    void* command;
    std::uint64_t part;
};
boost::lockfree::spsc_queue<Notice, boost::lockfree::capacity<64>> notices;
std::atomic<std::uint64_t> pending{0};
void push_notices(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        bool pushed = notices.push({&notices, i});
        keep(pushed);
        pending.fetch_or(1, std::memory_order_release);
    }
}
void take_notices(std::size_t) {
    notices.consume_all([](const Notice&) {});
    pending.store(0);
}

std::mutex mutex;
std::deque<Notice> queue_of_mutex;
void push_locked(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        const std::lock_guard locked{mutex};
        queue_of_mutex.push_back({&mutex, i});
    }
}
void take_locked(std::size_t) { queue_of_mutex.clear(); }

// ---- from the sending to the end

template <Measured& (*machine)()>
void run_receiver(std::size_t) {
    machine().far->run(true);
}
template <Measured& (*machine)()>
void send_all(std::size_t times) {
    machine().far->run(true);
    send<&Sender::note, machine>(times);
}
void send_all_to_one(std::size_t times) {
    carry_out_clocked(times);
    send<&Sender::clocked>(times);
}
void whole(std::size_t times) {
    for (std::size_t done = 0; done < times; done += senders) {
        send<&Sender::note>(senders);
        measured().far->run(true);
        for (Sender* sender : measured().sender) {
            bool ended = sender->note.state() == CommandState::done;
            keep(ended);
        }
    }
}
void whole_one(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        send<&Sender::note>(1);
        measured().far->run(true);
        bool ended = measured().sender[0]->note.state() == CommandState::done;
        keep(ended);
    }
}

struct Job {
    Listener* listener;
    double value;
    std::atomic<int> state{0};
};
std::array<Job, senders> jobs;
[[gnu::noinline]] bool do_job(Job& job) noexcept { return job.listener->note(job.value); }
bool (*volatile doing)(Job&) noexcept = &do_job;
void carry_out_notices() {
    if (pending.exchange(0, std::memory_order_acquire) == 0) return;
    Notice notice;
    while (notices.pop(notice)) {
        Job& job = *static_cast<Job*>(notice.command);
        job.state.store(doing(job) ? 2 : 3, std::memory_order_release);
    }
}
template <std::size_t receivers = senders> void push_jobs() {
    for (std::size_t i = 0; i < senders; ++i) {
        Job& job = jobs[i];
        job.listener = measured().listener[i % receivers];
        job.value = 1.0;
        job.state.store(1, std::memory_order_relaxed);
        static_cast<void>(notices.push({&job, i}));
        pending.fetch_or(1, std::memory_order_release);
    }
}
template <std::size_t receivers> void prepare_jobs(std::size_t) {
    take_notices(senders);
    push_jobs<receivers>();
}
void execute_bare(std::size_t) { carry_out_notices(); }
void whole_bare(std::size_t times) {
    for (std::size_t done = 0; done < times; done += senders) {
        push_jobs();
        carry_out_notices();
        for (Job& job : jobs) {
            bool ended = job.state.load(std::memory_order_acquire) == 2;
            keep(ended);
        }
    }
}

} // namespace

void add_commands(std::vector<Group>& groups) {
    constexpr const char *one_receiver = "engine step, all of one component",
                         *clock = "a reading of the clock",
                         *with_stamps = "engine step, with its time stamps";
    groups.push_back(
        {"dispatch.command.send",
         "a command sent to another activity",
         "thesis 4.5.2",
         senders,
         {{"send", Standing::ours, &send<&Sender::note>, &carry_out},
          {"send, the first one wakes", Standing::ours, &send<&Sender::note>, &carry_out_and_rest},
          {"send to a periodic activity", Standing::ours, &send<&Sender::clocked>, &carry_out_clocked},
          {"boost spsc_queue push of 16 bytes and atomic OR", Standing::floor, &push_notices, &take_notices},
          {"std::mutex and std::deque", Standing::peer, &push_locked, &take_locked}}});
    groups.back().goals.push_back({"command send <= one boost spsc_queue push plus one atomic OR",
                                   "send",
                                   1.0,
                                   {"boost spsc_queue push of 16 bytes and atomic OR"}});
    groups.push_back({"dispatch.command.execute",
                      "a command carried out by its engine, one of 32 in a cycle, each of another component",
                      "thesis 4.5.2",
                      senders,
                      {{"engine step, time stamps excluded", Standing::ours, &run_receiver<&measured>,
                        &send_all<&measured>},
                       {with_stamps, Standing::ours, &run_receiver<&measured_with_stamps>,
                        &send_all<&measured_with_stamps>},
                       {clock, Standing::floor, &read_clock<1>},
                       {"boost spsc_queue pop, call through a function pointer, store", Standing::floor,
                        &execute_bare, &prepare_jobs<senders>}},
                      {{"one of 32 queued commands to 32 receivers, with its time stamp <= 0.82 readings of "
                        "the clock (18 ns where one takes 22)",
                        with_stamps,
                        0.82,
                        {clock}}}});
    groups.push_back({"dispatch.command.for_one",
                      "a command carried out by its engine, one of 32 of one component, time stamps excluded",
                      "thesis 4.5.2",
                      senders,
                      {{one_receiver, Standing::ours, &carry_out_clocked, &send_all_to_one},
                       {"boost spsc_queue pop, call through a function pointer, store", Standing::floor,
                        &execute_bare, &prepare_jobs<1>},
                       {clock, Standing::floor, &read_clock<1>}}});
    groups.back().goals.push_back(
        {"one of 32 queued commands <= 0.9 readings of the clock (20 ns where one takes 22)",
         one_receiver,
         0.9,
         {clock}});
    groups.push_back({"dispatch.command.whole",
                      "a command sent, carried out and asked for its end, time stamps excluded",
                      "thesis 4.5.2",
                      senders,
                      {{"32 in a cycle", Standing::ours, &whole, &carry_out},
                       {"one in a cycle", Standing::ours, &whole_one, &carry_out},
                       {"boost spsc_queue, atomic word, function pointer, 32 in a turn", Standing::floor,
                        &whole_bare, &take_notices}}});
}

} // namespace tappet::figures
