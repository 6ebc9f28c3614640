// Requests into a running engine.
#include "kernel/machine/instance.hpp"

namespace tappet {

bool MachineInstance::post_request(std::size_t activity, const Message& message) noexcept TAPPET_REALTIME {
    const MailPlan& mail = machine_.plan.requests[activity];
    // The index of a mailbox that was not planned is another's.
    if (mail.capacity == 0 || !engines()[activity].inbox().post(mail.sender_index, message)) return false;
    waker_of(activity)();
    return true;
}

} // namespace tappet
