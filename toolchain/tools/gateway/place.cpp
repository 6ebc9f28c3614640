// A gateway's first requests to a machine.
#include "toolchain/tools/gateway/place.hpp"

#include "toolchain/tools/gateway/bounds.hpp"
#include "toolchain/tools/gateway/encoding.hpp"

#include "kernel/services/browsing/protocol.hpp"

#include <nlohmann/json.hpp>

#include <unistd.h>

namespace tappet::network {

using browser::failure;
using browser::Fault;

browser::Result<std::pair<browser::Link, std::shared_ptr<const Place>>> open_place(const std::string& socket,
                                                                                   std::string place) {
    auto link = browser::Link::connect(socket);
    if (!link) return std::unexpected(link.error());
    link->patience = bounds.machine_patience;
    // The gateway itself only looks, whatever its user may do.
    if (const auto lowered = link->request("as gateway observer network"); !lowered)
        return std::unexpected(lowered.error());
    const auto hello = link->request("hello");
    if (!hello) return std::unexpected(hello.error());
    if (hello->value("protocol", std::uint32_t{0}) != browsing::protocol_version)
        return failure(Fault::no_machine,
                       "it speaks another protocol; use the gateway that was built with it");
    if (const auto given = link->request("map"); !given) return std::unexpected(given.error());
    const int descriptor = link->take_descriptor();
    if (descriptor < 0)
        return failure(Fault::no_machine, "it handed no memory over; is it built with a browser service?");
    auto block = browser::SharedBlock::map(descriptor);
    ::close(descriptor);
    if (!block) return std::unexpected(block.error());
    auto map = browser::MapReader::open(block->bytes(), std::move(place));
    if (!map) return failure(Fault::no_machine, map.error());
    auto opened = std::make_shared<Place>(std::move(*block), std::move(*map));
    const auto text = [&](const char* name) { return as_utf8(hello->value(name, std::string{})); };
    opened->board = text("board");
    opened->world = text("world");
    opened->build_id = text("build_id");
    opened->framework = text("framework");
    return std::pair{std::move(*link), std::shared_ptr<const Place>{std::move(opened)}};
}

} // namespace tappet::network
