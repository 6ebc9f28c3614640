// The electronic data sheet of a device gives a byte a value that needs nine bits.
// refused: servo.eds:9: DefaultValue 256 does not fit the 8 bits of 6060h:0; correct it or its DataType
#include "drivers/canopen/eds.hpp"

inline constexpr tappet::SourceText servo{"servo.eds", R"([1000]
DataType=0x0007
AccessType=ro
DefaultValue=0x00020192

[6060]
DataType=0x0005
AccessType=rw
DefaultValue=256
)"};
constexpr const tappet::canopen::Dictionary& drive = tappet::canopen::dictionary<servo>;
