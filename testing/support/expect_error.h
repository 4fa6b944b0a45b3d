// EXPECT_ERROR(statement, code, "message"): the statement throws an Error that a program ends with this code for, and
// tells with exactly this message.
#pragma once

#include <gtest/gtest.h>

#include "apps/common/command_line.h"

#define EXPECT_ERROR(statement, expected_code, expected_message)                           \
    do {                                                                                   \
        try {                                                                              \
            statement;                                                                     \
            ADD_FAILURE() << "no error from " #statement;                                  \
        } catch (const cistula::Error& error) {                                            \
            EXPECT_EQ(cistula::exit_code(error.kind()), expected_code);                    \
            EXPECT_EQ(cistula::with_options(error.what()), std::string(expected_message)); \
        }                                                                                  \
    } while (false)
