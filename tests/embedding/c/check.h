/* What the test programs share: a check that says where it failed. */
#ifndef CHECK_H
#define CHECK_H

#include <stdio.h>
#include <stdlib.h>

#define CHECK(what)                                                                     \
    do {                                                                                \
        if (!(what)) {                                                                  \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #what);                  \
            exit(1);                                                                    \
        }                                                                               \
    } while (0)

/* Whether a call did what it was asked to; its message if not. */
#define DONE(m, call)                                                                   \
    do {                                                                                \
        bricard_status done_ = (call);                                                  \
        if (done_ != BRICARD_OK) {                                                      \
            fprintf(stderr, "%s:%d: %s: %d, %s\n", __FILE__, __LINE__, #call,           \
                    (int)done_, bricard_message(m));                                    \
            exit(1);                                                                    \
        }                                                                               \
    } while (0)

#endif
