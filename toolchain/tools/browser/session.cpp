// hello, then map: what every browser asks first.
#include "toolchain/tools/browser/session.hpp"

#include "kernel/services/browsing/protocol.hpp"

#include <nlohmann/json.hpp>

#include <unistd.h>

namespace tappet::browser {

Result<std::unique_ptr<Session>> Session::open(const std::string& socket,
                                               std::chrono::milliseconds patience) {
    auto link = Link::connect(socket);
    if (!link) return std::unexpected(link.error());
    link->patience = patience;
    const auto hello = link->request("hello");
    if (!hello) return std::unexpected(hello.error());
    const auto spoken = hello->value("protocol", std::uint32_t{0});
    if (spoken != browsing::protocol_version)
        return std::unexpected(Failure{
            Fault::no_machine, "the machine speaks protocol " + std::to_string(spoken) +
                                   ", this browser protocol " + std::to_string(browsing::protocol_version) +
                                   "; use the browser that was built with the firmware"});
    if (const auto given = link->request("map"); !given) return std::unexpected(given.error());
    const int descriptor = link->take_descriptor();
    if (descriptor < 0)
        return std::unexpected(Failure{
            Fault::no_machine, "the machine handed no memory over; is it built with a browser service?"});
    auto block = SharedBlock::map(descriptor);
    ::close(descriptor);
    if (!block) return std::unexpected(block.error());
    auto map = MapReader::open(block->bytes());
    if (!map) return std::unexpected(Failure{Fault::no_machine, map.error()});
    return std::unique_ptr<Session>{new Session{std::move(*link), std::move(*block), std::move(*map),
                                                hello->value("role", std::string{"unknown"})}};
}

} // namespace tappet::browser
