// SPDX-License-Identifier: MIT
// Scene files in other encodings than UTF-8.
#pragma once

#include <string>

namespace h2mc {

// The text of an XML file in UTF-8: of UTF-16 by its byte order mark or by a "<" of two bytes; of
// ISO-8859-1 where the XML declaration names it (or a relative of it), or where the bytes are no UTF-8.
// Without a byte order mark. What can't be told is returned as it is.
std::string toUtf8(std::string bytes);

}  // namespace h2mc
