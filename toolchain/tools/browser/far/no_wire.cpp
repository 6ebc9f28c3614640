// For another processor than the compiler's: the program runs beside its machine, and reaches no other box.
#include "toolchain/tools/browser/far/wire.hpp"

namespace tappet::browser {

Result<std::unique_ptr<FarWire>> FarWire::open(const Address& address, const Trust&, std::ostream&) {
    return wrong("this tappet-browse is built for a box, and does not reach " + address.text +
                 "; use the one of the host that Tappet was built on");
}

} // namespace tappet::browser
