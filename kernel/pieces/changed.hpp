// Writes an output only when its value changes, so that a connection wakes its reader only for new values.
#pragma once

#include "kernel/component/port.hpp"

namespace tappet {

/// The first call always writes. Real-time.
template <class T>
class Changed {
public:
    void write(Output<T>& output, const T& value) noexcept TAPPET_REALTIME {
        if (written_ && output.last() == value) return;
        written_ = true;
        output.write(value);
    }

private:
    bool written_ = false;
};

} // namespace tappet
