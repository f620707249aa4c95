#pragma once

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Sizes and offsets of the structs of percale.h; gives how many there are. */
size_t percale_sizes_in_c(size_t* sizes, size_t capacity);
/* 1 where a call without a simulation is refused. */
int percale_error_in_c(void);

#ifdef __cplusplus
}
#endif
