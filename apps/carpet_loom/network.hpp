// The CANopen network of the loom: starts nodes that report for duty, and tells when one is silent (CiA 301).
#pragma once

#include "apps/carpet_loom/wires.hpp"
#include "kernel/component/component.hpp"
#include "kernel/pieces/changed.hpp"

#include <array>

namespace tappet::carpet {

namespace wires = loom::wires;

/// All real-time, in a periodic activity.
struct Network {
    std::array<Input<std::int64_t>, wires::node::count> heartbeat;
    Output<std::int64_t> command;
    Output<std::int64_t> node;
    Output<bool> operational;
    Output<std::int64_t> silent_node;

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        to_start_ = 0;
        operational_.write(operational, false);
        silent_.write(silent_node, 0);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { operational_.write(operational, false); }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        std::int64_t silent = 0;
        bool all = true;
        for (std::size_t i = 0; i < heartbeat.size(); ++i) {
            std::int64_t state = -1;
            const Flow flow = heartbeat[i].read(state);
            const auto id = static_cast<std::int64_t>(i + 1);
            if (flow == Flow::stale || flow == Flow::never_written) {
                all = false;
                if (flow == Flow::stale && silent == 0) silent = id;
                continue;
            }
            if (state == wires::nmt_state::operational) continue;
            all = false;
            if (flow == Flow::fresh) to_start_ |= 1u << i;
        }
        send_start(cycle);
        operational_.write(operational, all);
        silent_.write(silent_node, silent);
    }

    static constexpr auto interface() {
        std::array<Facet, wires::node::count + 4> list{};
        constexpr std::array<std::string_view, wires::node::count> names{
            "heartbeat_1", "heartbeat_2", "heartbeat_3", "heartbeat_4", "heartbeat_5", "heartbeat_6"};
        std::size_t n = 0;
        for (std::size_t i = 0; i < names.size(); ++i)
            list[n++] = {.name = names[i],
                         .doc = "state of the node",
                         .kind = FacetKind::input,
                         .type = type_id<std::int64_t>,
                         .required = true,
                         .index = i,
                         .at = [](void* self, std::size_t k) noexcept -> void* {
                             return &static_cast<Network*>(self)->heartbeat[k];
                         },
                         .port = &PortAccess::data<std::int64_t>};
        list[n++] = output<&Network::command>("command", "", "NMT command");
        list[n++] = output<&Network::node>("node", "", "NMT node");
        list[n++] = output<&Network::operational>("operational", "", "every node works; written on change");
        list[n++] = output<&Network::silent_node>(
            "silent_node", "", "a node whose heartbeat is missing, 0: none; written on change");
        return list;
    }

private:
    /// One command a period, a pause apart: a node answers with its next heartbeat only.
    void send_start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        if (to_start_ == 0 || cycle.now < next_command_) return;
        for (std::size_t i = 0; i < heartbeat.size(); ++i) {
            if ((to_start_ & (1u << i)) == 0) continue;
            to_start_ &= ~(1u << i);
            command.write(wires::nmt_command::start);
            node.write(static_cast<std::int64_t>(i + 1));
            next_command_ = cycle.now + 5ms;
            return;
        }
    }

    std::uint32_t to_start_ = 0;
    Time next_command_{};
    Changed<bool> operational_;
    Changed<std::int64_t> silent_;
};

} // namespace tappet::carpet
