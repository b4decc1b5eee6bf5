#pragma once
/// \file
/// Binary data inside XML as VTK wants it: blocks compressed by zlib, a header with their sizes, both in base64.

#include <cstddef>
#include <string>
#include <string_view>

namespace karcher {

/// Appends the base64 text (RFC 4648, with padding) of `size` bytes.
void append_base64(std::string& out, const void* data, std::size_t size);

/// Appends header and data: 64-bit numbers {blocks, block size, size of the last block if it is a part of one (else 0), compressed size of every block} and the
/// compressed blocks, each of the two as base64 of its own (VTK file formats, "compressed data"; header_type="UInt64").
void append_compressed(std::string& out, const void* data, std::size_t size);

/// The bytes of what append_compressed wrote; spaces around it are skipped. \throws InputError with a sentence that says what is wrong, without the file
std::string read_compressed(std::string_view text);

}  // namespace karcher
