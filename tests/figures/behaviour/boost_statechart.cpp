// The loom's cycle in Boost.Statechart.
#include "tests/figures/behaviour/peers.hpp"

#include <boost/mpl/list.hpp>
#include <boost/statechart/custom_reaction.hpp>
#include <boost/statechart/event.hpp>
#include <boost/statechart/simple_state.hpp>
#include <boost/statechart/state_machine.hpp>
#include <boost/statechart/transition.hpp>

namespace tappet::figures {

LoomCounts statechart_counts;

namespace {

namespace sc = boost::statechart;
namespace mpl = boost::mpl;

struct Power : sc::event<Power> {};
struct Start : sc::event<Start> {};
struct Stop : sc::event<Stop> {};
struct Faster : sc::event<Faster> {};
struct Slower : sc::event<Slower> {};
struct Pick : sc::event<Pick> {};
struct Broken : sc::event<Broken> {};
struct Reset : sc::event<Reset> {};

struct Counted {
    Counted() { ++statechart_counts.entries; }
    ~Counted() { ++statechart_counts.exits; }
};

struct Off;
struct On;
struct Idle;
struct Weaving;
struct Slow;
struct Fast;
struct Fault;
struct Machine : sc::state_machine<Machine, Off> {};

struct Off : Counted, sc::simple_state<Off, Machine> {
    using reactions = sc::transition<Power, On>;
};
struct On : Counted, sc::simple_state<On, Machine, Idle> {
    using reactions = mpl::list<sc::transition<Power, Off>, sc::transition<Broken, Fault>>;
};
struct Idle : Counted, sc::simple_state<Idle, On> {
    using reactions = sc::custom_reaction<Start>;
    sc::result react(const Start&) {
        return statechart_counts.picks >= 0 ? transit<Weaving>() : forward_event();
    }
};
struct Weaving : Counted, sc::simple_state<Weaving, On, Slow> {
    using reactions = mpl::list<sc::transition<Stop, Idle>, sc::custom_reaction<Pick>>;
    sc::result react(const Pick&) {
        ++statechart_counts.picks;
        return discard_event();
    }
};
struct Slow : Counted, sc::simple_state<Slow, Weaving> {
    using reactions = sc::custom_reaction<Faster>;
    sc::result react(const Faster&) {
        return statechart_counts.picks >= 0 ? transit<Fast>() : forward_event();
    }
};
struct Fast : Counted, sc::simple_state<Fast, Weaving> {
    using reactions = sc::transition<Slower, Slow>;
};
struct Fault : Counted, sc::simple_state<Fault, Machine> {
    using reactions = mpl::list<sc::transition<Reset, On>, sc::transition<Power, Off>>;
};

Machine machines[peer_machines];

} // namespace

void statechart_start() {
    for (Machine& machine : machines) machine.initiate();
    statechart_counts = {0, 1, 0}; // of one machine
}
template <int number>
void statechart_dispatch(std::size_t event) {
    Machine& machine = machines[number];
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
template void statechart_dispatch<0>(std::size_t event);
template void statechart_dispatch<1>(std::size_t event);

} // namespace tappet::figures
