// RouDi as iceoryx' own example of a single process starts it, with memory pools for these packets only.
#include "tests/figures/exchange/iceoryx.hpp"

#if defined(TAPPET_HAS_ICEORYX)

#include <iceoryx_hoofs/log/logmanager.hpp>
#include <iceoryx_hoofs/posix_wrapper/file_lock.hpp>
#include <iceoryx_posh/iceoryx_posh_types.hpp>
#include <iceoryx_posh/internal/roudi/roudi.hpp>
#include <iceoryx_posh/popo/publisher.hpp>
#include <iceoryx_posh/popo/subscriber.hpp>
#include <iceoryx_posh/roudi/iceoryx_roudi_components.hpp>
#include <iceoryx_posh/runtime/posh_runtime_single_process.hpp>

#include <memory>
#include <tuple>

namespace tappet::figures {

namespace {

constexpr std::uint32_t chunks = 64;

iox::RouDiConfig_t pools() {
    iox::mepoo::MePooConfig pools;
    for (const std::uint32_t bytes : {64u, 192u, 4128u}) pools.addMemPool({bytes, chunks});
    iox::RouDiConfig_t config;
    const auto group = iox::posix::PosixGroup::getGroupOfCurrentProcess().getName();
    config.m_sharedMemorySegments.push_back({group, group, pools});
    return config;
}

template <std::size_t bytes, bool queue>
struct Pair {
    iox::popo::Publisher<Packet<bytes>> publisher;
    iox::popo::Subscriber<Packet<bytes>> subscriber;
    static iox::capro::ServiceDescription service() {
        return {"Tappet", queue ? "Queue" : "Value",
                iox::capro::IdString_t{iox::cxx::TruncateToCapacity, std::to_string(bytes)}};
    }
    static iox::popo::SubscriberOptions options() {
        iox::popo::SubscriberOptions options;
        options.queueCapacity = queue ? queue_places : 1;
        return options;
    }
    Pair() : publisher{service()}, subscriber{service(), options()} {}
};

struct Daemon {
    iox::roudi::IceOryxRouDiComponents components{pools()};
    iox::roudi::RouDi roudi{
        components.rouDiMemoryManager, components.portManager,
        iox::roudi::RouDi::RoudiStartupParameters{iox::roudi::MonitoringMode::OFF, false}};
    iox::runtime::PoshRuntimeSingleProcess runtime{"tappet-figures"};
    std::tuple<Pair<8, false>, Pair<8, true>, Pair<160, false>, Pair<160, true>, Pair<4096, false>,
               Pair<4096, true>>
        pairs{};
};
std::unique_ptr<Daemon> daemon;

template <std::size_t bytes, bool queue>
auto& pair_of() {
    return std::get<Pair<bytes, queue>>(daemon->pairs);
}

} // namespace

std::string start_iceoryx() {
    iox::log::LogManager::GetLogManager().SetDefaultLogLevel(iox::log::LogLevel::kError);
    // RouDi ends the whole process when another one runs.
    if (iox::posix::FileLock::create(iox::roudi::ROUDI_LOCK_NAME).has_error())
        return "another process of this machine runs iceoryx' RouDi, or its lock cannot be made";
    daemon = std::make_unique<Daemon>();
    return {};
}

void stop_iceoryx() { daemon.reset(); }

template <std::size_t bytes, bool queue>
bool Iceoryx<bytes, queue>::give(const Packet<bytes>& value) noexcept {
    bool done = false;
    pair_of<bytes, queue>().publisher.loan().and_then([&](auto& sample) {
        *sample = value;
        sample.publish();
        done = true;
    });
    return done;
}

template <std::size_t bytes, bool queue>
bool Iceoryx<bytes, queue>::take(Packet<bytes>& into) noexcept {
    bool done = false;
    pair_of<bytes, queue>().subscriber.take().and_then([&](auto& sample) {
        into = *sample;
        done = true;
    });
    return done;
}

} // namespace tappet::figures

#else

namespace tappet::figures {
std::string start_iceoryx() { return "it was not installed when this was built; ci/setup does it"; }
void stop_iceoryx() {}
template <std::size_t bytes, bool queue>
bool Iceoryx<bytes, queue>::give(const Packet<bytes>&) noexcept {
    return false;
}
template <std::size_t bytes, bool queue>
bool Iceoryx<bytes, queue>::take(Packet<bytes>&) noexcept {
    return false;
}
} // namespace tappet::figures

#endif

namespace tappet::figures {
template struct Iceoryx<8, false>;
template struct Iceoryx<160, false>;
template struct Iceoryx<4096, false>;
template struct Iceoryx<8, true>;
template struct Iceoryx<160, true>;
template struct Iceoryx<4096, true>;
} // namespace tappet::figures
