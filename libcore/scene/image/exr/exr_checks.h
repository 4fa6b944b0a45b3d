// What is checked of an OpenEXR file before its pixels are read, for all of its readers. Private to image/.
#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>

#include <cerrno>
#include <exception>
#include <new>
#include <string>

#include "scene/base/file_bytes.h"

namespace cistula {

/// Runs `read`; the library's exceptions become an Error that names the file, or std::bad_alloc.
template <class Read>
auto with_file_errors(const std::string& path, Read read) {
    errno = 0;
    try {
        return read();
    } catch (const Error&) {
        if (errno == ENOMEM) throw std::bad_alloc();  // the library takes what it could not read for missing
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& failure) {
        if (errno == ENOMEM) throw std::bad_alloc();
        throw file_error(path, "read", std::string(failure.what()));
    }
}

/// What has to be done before the library opens a file, so that a damaged header cannot make it allocate huge arrays:
/// its limits are set, and check_exr_header.
void check_before_opening(const std::string& path);

/// Throws for several samples in a pixel; the message calls the part `subject`.
void check_flat(const Imf::Header& header, const std::string& subject = "it");

/// Throws unless a channel has one value per pixel, or, where it `may_be_halved`, one for two by two.
void check_sampling(const std::string& name, const Imf::Channel& channel, bool may_be_halved = false);

/// Throws unless all channels have one value per pixel; where `is_chroma`, RY and BY may have one for two by two.
void check_sampling(const Imf::Header& header, bool is_chroma = false);

/// Throws for a header that says more pixels than a file of its size can hold, before memory is taken for them.
void check_claim(const Imf::Header& header, const std::string& path);

/// Throws unless every chunk is present. The table of offsets is not enough: it precedes the pixels, so a truncated
/// file has all of it. Tiles are checked when their pixels are read. File: Imf::InputFile, Imf::InputPart
/// or Imf::TiledInputPart.
template <class File>
void check_chunks(File& file);

}  // namespace cistula
