// SPDX-License-Identifier: MIT
#include "render/path/local_form_steps.h"

namespace h2mc {
template class LocalForm<double, true>;
}
