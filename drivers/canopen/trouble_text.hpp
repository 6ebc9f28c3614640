// Messages about a node that keeps its machine from working: node, object, expected and found value, and the
// cure.
#pragma once

#include "drivers/canopen/node_watch.hpp"

namespace tappet::canopen {

namespace detail {

inline void add_value(Sentence& to, std::uint64_t value, const ConfigurationStep& step) noexcept
    TAPPET_REALTIME {
    add_hex(to, value, 2u * step.bytes);
}
inline void add_object(Sentence& to, Address at) noexcept TAPPET_REALTIME {
    to.add("object ");
    add_hex(to, at.index, 4);
    to.add(":").add(unsigned{at.sub});
}

} // namespace detail

/// Returns the message; `step` is the one that the trouble names. Real-time.
inline Sentence to_text(const WatchedNode& node, const NodeTrouble& trouble,
                        const ConfigurationStep& step) noexcept TAPPET_REALTIME {
    Sentence text;
    text.add("node ").add(unsigned{node.id}).add(" \"").add(node.name).add("\": ");
    switch (trouble.kind) {
    case NodeTrouble::Kind::none: return text.add("it is on its way");
    case NodeTrouble::Kind::silent:
        return text.add("its heartbeat is missing; look at its supply and its cable");
    case NodeTrouble::Kind::no_answer:
        return text.add("it does not answer; look at its supply, its identifier and the bit rate");
    case NodeTrouble::Kind::rebooted: return text.add("it booted again while it worked; look at its supply");
    case NodeTrouble::Kind::left:
        return text.add("it left its operational state by itself; look at its errors");
    case NodeTrouble::Kind::other_device:
        detail::add_object(text, step.at);
        detail::add_value(text.add(" must be "), step.value, step);
        detail::add_value(text.add(" and is "), trouble.found, step);
        return text.add("; connect a \"").add(node.product).add("\" as ").add(node.file).add(" describes it");
    case NodeTrouble::Kind::not_kept:
        detail::add_object(text, step.at);
        detail::add_value(text.add(" was to be "), step.value, step);
        detail::add_value(text.add(" and reads "), trouble.found, step);
        return text.add("; the device does not take this configuration: correct the network's table");
    case NodeTrouble::Kind::aborted:
        detail::add_object(text, step.at);
        text.add(step.kind == ConfigurationStep::Kind::write ? " was not written" : " was not read");
        add_hex(text.add(", abort "), static_cast<std::uint32_t>(trouble.why), 8);
        text.add(" (").add(to_text(trouble.why)).add("); ");
        if (passes(trouble.why)) return text.add("it is asked again: look at the device");
        return text.add("correct the network's table or ").add(node.file);
    }
    return text;
}

} // namespace tappet::canopen
