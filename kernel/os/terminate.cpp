// The handler of std::terminate in a firmware: abort, which stops the machine safely. The library's own
// handler prints an exception's name, and links code to decode such names: more code than the kernel has.
#include <cstdlib>
#include <exception>

namespace __cxxabiv1 {
extern std::terminate_handler __terminate_handler;
std::terminate_handler __terminate_handler = &std::abort;
} // namespace __cxxabiv1
