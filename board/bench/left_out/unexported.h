/* SPDX-License-Identifier: Apache-2.0 */
/* irq_sim is meant to be built into the kernel and calls irq_to_desc, which modules cannot reach. The same
 * descriptor is reachable through its interrupt data, which they can. */
#include <linux/irq.h>
#include <linux/irqdesc.h>
#define irq_to_desc(irq) irq_data_to_desc(irq_get_irq_data(irq))
