/* SPDX-License-Identifier: Apache-2.0 */
/* The findings of libmodbus's configure script for Debian on x86-64, and one decision of ours. */
#ifndef TAPPET_LIBMODBUS_CONFIG_H
#define TAPPET_LIBMODBUS_CONFIG_H

#include <netdb.h>
#include <sys/ioctl.h>

#define HAVE_ACCEPT4 1
#define HAVE_BYTESWAP_H 1
#define HAVE_DECL_TIOCM_RTS 1
#define HAVE_DECL_TIOCSRS485 1
#define HAVE_DECL___CYGWIN__ 0

/* A static binary cannot resolve host names: glibc would load its resolver at run time. A board names its Modbus
 * devices by address (modbus_new_tcp); the variant that resolves (modbus_new_tcp_pi) fails at once. */
#define getaddrinfo(node, service, hints, result) ((void)(hints), (void)(result), EAI_SYSTEM)
#define freeaddrinfo(list) ((void)(list))

#endif
