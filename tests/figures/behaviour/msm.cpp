// The loom's cycle in Boost.MSM: functor front end, submachines for the composite states.
#include "tests/figures/behaviour/peers.hpp"

#include <boost/msm/back/state_machine.hpp>
#include <boost/msm/front/functor_row.hpp>
#include <boost/msm/front/state_machine_def.hpp>

namespace tappet::figures {

LoomCounts msm_counts;

namespace {

namespace msm = boost::msm;
namespace mpl = boost::mpl;
using msm::front::none;
using msm::front::Row;

struct Power {};
struct Start {};
struct Stop {};
struct Faster {};
struct Slower {};
struct Pick {};
struct Broken {};
struct Reset {};

template <class Base> struct Counted : Base {
    template <class E, class M> void on_entry(const E&, M&) { ++msm_counts.entries; }
    template <class E, class M> void on_exit(const E&, M&) { ++msm_counts.exits; }
};
using Leaf = Counted<msm::front::state<>>;
template <class Self> struct Composite : Counted<msm::front::state_machine_def<Self>> {
    using no_exception_thrown = int;
    using no_message_queue = int;
    template <class M, class E> void no_transition(const E&, M&, int) {}
};

struct May {
    template <class E, class M, class S, class T> bool operator()(const E&, M&, S&, T&) const {
        return msm_counts.picks >= 0;
    }
};
struct Count {
    template <class E, class M, class S, class T> void operator()(const E&, M&, S&, T&) const {
        ++msm_counts.picks;
    }
};

struct Slow : Leaf {};
struct Fast : Leaf {};
struct WeavingDef : Composite<WeavingDef> {
    using initial_state = Slow;
    struct transition_table
        : mpl::vector<Row<Slow, Faster, Fast, none, May>, Row<Fast, Slower, Slow, none, none>> {};
};
using Weaving = msm::back::state_machine<WeavingDef>;

struct Idle : Leaf {};
struct OnDef : Composite<OnDef> {
    using initial_state = Idle;
    struct transition_table
        : mpl::vector<Row<Idle, Start, Weaving, none, May>, Row<Weaving, Stop, Idle, none, none>,
                      Row<Weaving, Pick, none, Count, none>> {};
};
using On = msm::back::state_machine<OnDef>;

struct Off : Leaf {};
struct Fault : Leaf {};
struct LoomDef : msm::front::state_machine_def<LoomDef> {
    using no_exception_thrown = int;
    using no_message_queue = int;
    using initial_state = Off;
    struct transition_table
        : mpl::vector<Row<Off, Power, On, none, none>, Row<On, Power, Off, none, none>,
                      Row<On, Broken, Fault, none, none>, Row<Fault, Reset, On, none, none>,
                      Row<Fault, Power, Off, none, none>> {};
    template <class M, class E> void no_transition(const E&, M&, int) {}
};

msm::back::state_machine<LoomDef> machines[peer_machines];

} // namespace

void msm_start() {
    for (auto& machine : machines) machine.start();
    msm_counts = {0, 1, 0}; // of one machine
}

template <int number>
void msm_dispatch(std::size_t event) {
    auto& machine = machines[number];
    switch (event) {
    case power: machine.process_event(Power{}); break;
    case start: machine.process_event(Start{}); break;
    case stop: machine.process_event(Stop{}); break;
    case faster: machine.process_event(Faster{}); break;
    case slower: machine.process_event(Slower{}); break;
    case pick: machine.process_event(Pick{}); break;
    case broken: machine.process_event(Broken{}); break;
    case reset: machine.process_event(Reset{}); break;
    default: break;
    }
}
template void msm_dispatch<0>(std::size_t event);
template void msm_dispatch<1>(std::size_t event);

} // namespace tappet::figures
