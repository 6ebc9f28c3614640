// The sources of Boost's networking libraries, compiled once.
#include <utility> // Boost 1.74 needs std::exchange before its own headers

#include <boost/asio/impl/src.hpp>
#include <boost/asio/ssl/impl/src.hpp>
#include <boost/beast/src.hpp>
