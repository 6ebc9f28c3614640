// An event with its subscribers, lanes and a receiving end, as start-up places them.
#pragma once

#include "kernel/component/component.hpp"
#include "tests/kernel/exchange/placed.hpp"

#include <array>
#include <cstddef>
#include <deque>
#include <vector>

namespace tappet {

/// An event with room for eight rows.
template <class... A>
struct EmitterOf {
    static constexpr const EventOperations& operations = PortAccess::event<A...>;
    Event<A...> event;
    std::array<Subscriber<A...>, 8> subscribers{};
    std::deque<GatedComponent> gates; ///< gates of the called components
    std::size_t rows = 0;
    EmitterOf() { operations.give_storage(&event, subscribers.data()); }

    EventHandle subscribe(const void* call, void* context, std::atomic<std::uint32_t>* epoch) {
        std::atomic<std::uint64_t>& connected = operations.subscribe(&event, call, context);
        const EventHandle handle{connected, std::uint64_t{1} << rows++, epoch};
        handle.connect();
        return handle;
    }
    EventHandle call(const OperationOperations& operation, void* component) {
        return subscribe(operation.enter, &gates.emplace_back(component, ComponentState::running), nullptr);
    }
    EventHandle tell(AsyncReaction& row) {
        row.bit = std::uint64_t{1} << rows;
        row.connected = &operations.subscribe(&event, operations.post, &row);
        const EventHandle handle{*row.connected, std::uint64_t{1} << rows++, &row.epoch};
        handle.connect();
        return handle;
    }
};

using Emitter = EmitterOf<double>;

using Receiver = PlacedInbox; ///< the receiving end for several sending activities

/// An asynchronous row to a receiver with a lane for each of its senders; activity 0 is the first of them.
struct Row {
    Row(Receiver& receiver, const OperationOperations& operation, void* component, std::uint32_t quota,
        bool keeps_latest = false, std::size_t argument_bytes = 0)
        : gate{component, ComponentState::running},
          lanes(receiver.mailboxes.size()),
          latest(receiver.mailboxes.size()),
          lane_of(lanes.size()) {
        const std::size_t bytes = parcel_bytes(argument_bytes);
        const std::uint32_t places = parcel_places(quota, keeps_latest);
        parcels.resize(lanes.size() * places * bytes);
        row.parcel_bytes = static_cast<std::uint32_t>(bytes);
        row.parcel_mask = places - 1;
        for (std::size_t i = 0; i < lanes.size(); ++i) {
            lanes[i].row = &row;
            lanes[i].sender = i;
            if (keeps_latest) lanes[i].latest = &latest[i];
            if (bytes != 0) lanes[i].parcels = parcels.data() + i * places * bytes;
            lane_of[i] = static_cast<std::uint8_t>(i);
        }
        row.inbox = &receiver.inbox;
        row.operation = operation.run;
        row.receiver = &gate;
        row.lanes = lanes.data();
        row.lane_of = lane_of.data();
        row.activities = row.lane_count = static_cast<std::uint32_t>(lanes.size());
        row.quota = quota;
    }
    Row(const Row&) = delete;
    Row& operator=(const Row&) = delete;
    GatedComponent gate;
    std::vector<EventLane> lanes;
    std::vector<LatestMessage> latest;
    std::vector<std::uint8_t> lane_of;
    std::vector<std::byte> parcels;
    AsyncReaction row;
};

} // namespace tappet
