// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace doorforge::internal {

/// The numbers of a small tensor that torch.save() wrote, in row-major order.
///
/// The format since PyTorch 1.6: a ZIP archive of stored (not compressed) members,
/// `<name>/data.pkl`, a pickle of protocol 2 that rebuilds the tensor, and `<name>/data/<key>`, its
/// elements, little endian. Of the pickle only what describes a tensor of float, double, int or
/// long is understood; nothing in it is run. Also reads the .npy file that the name promises.
///
/// @throws Error(kMissing, kIo) as ReadFile(); Error(kFormat) on anything else, or more than
///     `max_count` numbers.
std::vector<double> ReadTorchNumbers(const std::filesystem::path& path, std::size_t max_count);
std::vector<double> ParseTorchNumbers(std::string_view bytes, const std::string& name,
                                      std::size_t max_count);

}  // namespace doorforge::internal
