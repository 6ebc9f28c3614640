// The facets of a node's end of the wire: each has the type of the facet that it stands in for.
#pragma once

#include "drivers/system/node_rows.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/nth.hpp"

namespace tappet::systems {

/// A command call with any signature.
template <std::size_t most_bytes>
struct PackedCommandCall {
    CommandSlot slot{};
    std::array<std::byte, most_bytes> values{};

    static constexpr CommandCallOperations operations{
        [](void* call) { return &static_cast<PackedCommandCall*>(call)->slot; },
        [](void* call) { return static_cast<PackedCommandCall*>(call)->values.data(); }};
};

/// The facets of a Link.
template <class Link>
struct LinkFacets {
    using Rows = typename Link::Rows;
    static constexpr std::size_t row_count = Rows::row_count;

    template <std::size_t i>
    struct Call { // ordinary functions: clang 22 drops the effects of a template's as an argument
        static bool begin(void* link, std::byte* values) noexcept TAPPET_REALTIME {
            return Link::template begin_call<i>(link, values);
        }
        static CommandProgress progress(void* link, std::byte* values) noexcept TAPPET_REALTIME {
            return Link::template call_progress<i>(link, values);
        }
        using Gated = GatedCommand<&begin, &progress>;
    };
    template <std::size_t... i>
    static constexpr auto command_operations(std::index_sequence<i...>) {
        return std::array<CommandOperations, sizeof...(i)>{
            CommandOperations{Rows::is_command(i) ? Rows::command(i).arguments : nullptr,
                              Rows::is_command(i) ? Rows::command(i).results : nullptr,
                              Rows::is_command(i) ? Rows::command(i).argument_bytes : 0,
                              Rows::is_command(i) ? Rows::command(i).result_bytes : 0, &Call<i>::Gated::begin,
                              &Call<i>::Gated::progress}...};
    }
    static constexpr auto commands = command_operations(std::make_index_sequence<row_count>{});

    static constexpr Facet port_facet(std::size_t p) {
        const PortPlace& port = Rows::ports[p];
        return {.name = Rows::port_names[p].view(),
                .unit = port.facet->unit,
                .doc = port.is_input ? "sent to other nodes" : "received from another node",
                .kind = port.is_input ? FacetKind::input : FacetKind::output,
                .type = port.facet->type,
                .at_rest = AtRest::as_it_was,
                .index = p,
                .at = [](void* self, std::size_t i) noexcept -> void* {
                    return static_cast<Link*>(self)->storage_.data() + Rows::ports[i].at;
                },
                .port = port.facet->port};
    }
    static constexpr std::size_t add_row(std::size_t i, std::span<Facet> into) {
        const Facet& from = Rows::facet_from(i);
        Facet facet{.name = Rows::row_names[i].view(), .type = from.type, .index = i};
        if (Rows::sends_events(i)) {
            facet.doc = "goes to another node";
            facet.kind = FacetKind::wait;
            facet.at = [](void* self, std::size_t k) noexcept -> void* {
                return static_cast<EventWaitState*>(&static_cast<Link*>(self)->emitted[k]);
            };
            into[0] = facet;
            into[1] = nth_event<&Link::lost>(i, Rows::loss_names[i].view(), "nobody has answered in time");
            return 2;
        }
        if (!Rows::is_command(i)) {
            facet.doc = "comes from another node";
            facet.kind = FacetKind::event;
            facet.at = [](void* self, std::size_t k) noexcept -> void* {
                return static_cast<Link*>(self)->storage_.data() + Rows::rows[k].event_at;
            };
            facet.event = from.event;
        } else if (Rows::serves_command(i)) {
            facet.doc = "sent by another node";
            facet.kind = FacetKind::command_call;
            facet.at = [](void* self, std::size_t k) noexcept -> void* {
                return &static_cast<Link*>(self)->calls[k];
            };
            facet.command_call = &Link::CommandCallSlot::operations;
        } else {
            facet.doc = "done by another node";
            facet.kind = FacetKind::command;
            facet.command = &commands[i];
        }
        into[0] = facet;
        return 1;
    }
    static constexpr auto list() {
        constexpr std::size_t fixed = 8 + (Rows::is_told_time ? 3 : 0), node_count = Link::node_count;
        std::array<Facet, fixed + node_count - 1 + Rows::port_count + Rows::facet_count> list{};
        std::size_t k = 0;
        for (const Facet& facet : {
                 input<&Link::received>("received", "", "frames of the wire"),
                 output<&Link::refused>("refused", "",
                                        "the row that another node has differently; written on change"),
                 output<&Link::events_lost>("events_lost", "",
                                            "events that no node answered in time; written on change"),
                 output<&Link::frames_refused>("frames_refused", "",
                                               "damaged, or of another version; written on change"),
                 output<&Link::beyond>("beyond", "", "values that their bits cannot hold; written on change"),
                 output<&Link::not_sent>("not_sent", "",
                                         "frames that a faulted or full bus did not take; written on change"),
                 output<&Link::held_back>("held_back", "",
                                          "events and commands that came sooner than their at_most(...); "
                                          "written on change"),
                 timer<&Link::next, &Link::fire>("next", "the next frame, or the next silence"),
             })
            list[k++] = facet;
        if constexpr (Rows::is_told_time) {
            list[k++] = input<&Link::ahead>("ahead", "s", "how far the common clock is ahead of the own one");
            list[k++] = input<&Link::knows_time>("knows_time", "", "the common time is known well enough");
            list[k++] = input<&Link::exchanges>("exchanges", "", "times that the common clock was received");
        }
        for (std::size_t node = 0; node < node_count; ++node)
            if (node != Link::this_node)
                list[k++] =
                    nth_output<&Link::is_there>(node, Rows::presence_names[node].view(), "",
                                                "it is heard; written on change", while_stopped(false));
        for (std::size_t p = 0; p < Rows::port_count; ++p) list[k++] = port_facet(p);
        for (std::size_t i = 0; i < row_count; ++i)
            if (Rows::crossing(i).kind != CrossingKind::data) k += add_row(i, std::span{list}.subspan(k));
        return list;
    }
};

} // namespace tappet::systems
