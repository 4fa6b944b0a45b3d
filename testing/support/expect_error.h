// EXPECT_ERROR(statement, code, "message"): the statement throws Error with that code and with exactly this message.
#pragma once

#include <gtest/gtest.h>

#include "base/error.h"

#define EXPECT_ERROR(statement, expected_code, expected_message)                 \
    do {                                                                         \
        try {                                                                    \
            statement;                                                           \
            ADD_FAILURE() << "no error from " #statement;                        \
        } catch (const cistula::Error& error) {                                  \
            EXPECT_EQ(error.code(), expected_code);                              \
            EXPECT_EQ(std::string(error.what()), std::string(expected_message)); \
        }                                                                        \
    } while (false)
