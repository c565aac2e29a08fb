// JSON text to a document and back, without trust in its size, depth or encoding.
#pragma once

#include <string>
#include <string_view>

#include "limber/document/asset.h"

namespace limber {

// Keeps the order of keys and every number: whole numbers of 64 bits as such, others as the nearest double. Where an
// object has a key twice the last one counts, with a warning "duplicate-keys". Throws Error kBadData with the byte
// offset where the text breaks JSON or UTF-8, kLimit on nesting deeper than 200 or an object of more than 65536 keys. A
// byte order mark is skipped. Linear in the length of the text.
Json parseJson(std::string_view text, Warnings& warnings);

// indent < 0: no white space. Throws Error kBadData where a string is not UTF-8.
std::string dumpJson(const Json& json, int indent);

// For what limber says itself: what is not UTF-8 in a name out of a file or of a file is replaced, and what a terminal
// would obey (control characters, U+007F to U+009F too) is escaped, so that the text is JSON as it is shown.
std::string dumpReport(const Json& json, int indent = 2);

// [{"kind", "message", "where", "count"}], in order.
Json toJson(const Warnings& warnings);

}  // namespace limber
