// What std::terminate runs in a firmware: abort, which stops the machine safely. The library's own handler
// prints the name of an exception, and brings along what takes such names apart: more code than the kernel
// itself has.
#include <cstdlib>
#include <exception>

namespace __cxxabiv1 {
extern std::terminate_handler __terminate_handler;
std::terminate_handler __terminate_handler = &std::abort;
} // namespace __cxxabiv1
