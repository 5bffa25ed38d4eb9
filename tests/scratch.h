// Files that tests write. Several test programs run at the same time, so each run of one has a folder to itself, in the
// system's temporary folder: it is removed at the end, and stays where a test has failed.

#pragma once

#include <string>

namespace lyr::tests {

// A path in that folder, which is there.
std::string scratch(const std::string& name);

// An empty folder of that name in it, whatever an earlier test has left there.
std::string scratch_folder(const std::string& name);

}  // namespace lyr::tests
