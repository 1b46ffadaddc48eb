// SPDX-License-Identifier: LGPL-2.1-or-later
// Lets ThreadSanitizer see GLib's locks and reference counts. GLib is not built for it, and its
// locks are futexes of its own: without this a correctly locked program is full of reports. Each
// function does what GLib's does and says what that orders. Built without the sanitizer.
#include <glib-object.h>
#include <gst/gst.h>

#include <dlfcn.h>

extern "C" {
void __tsan_acquire(void* address);
void __tsan_release(void* address);
}

namespace {

template <class Function>
Function* original(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

#define RG_REAL(name) static auto* const real = original<decltype(name)>(#name)

#define RG_LOCK(name, Lock) \
  void name(Lock* lock) {   \
    RG_REAL(name);          \
    real(lock);             \
    __tsan_acquire(lock);   \
  }
#define RG_TRYLOCK(name, Lock)            \
  gboolean name(Lock* lock) {             \
    RG_REAL(name);                        \
    const gboolean isLocked = real(lock); \
    if (isLocked) __tsan_acquire(lock);   \
    return isLocked;                      \
  }
#define RG_UNLOCK(name, Lock) \
  void name(Lock* lock) {     \
    RG_REAL(name);            \
    __tsan_release(lock);     \
    real(lock);               \
  }

extern "C" {

RG_LOCK(g_mutex_lock, GMutex)
RG_TRYLOCK(g_mutex_trylock, GMutex)
RG_UNLOCK(g_mutex_unlock, GMutex)
RG_LOCK(g_rec_mutex_lock, GRecMutex)
RG_TRYLOCK(g_rec_mutex_trylock, GRecMutex)
RG_UNLOCK(g_rec_mutex_unlock, GRecMutex)
RG_LOCK(g_rw_lock_writer_lock, GRWLock)
RG_TRYLOCK(g_rw_lock_writer_trylock, GRWLock)
RG_UNLOCK(g_rw_lock_writer_unlock, GRWLock)
RG_LOCK(g_rw_lock_reader_lock, GRWLock)
RG_TRYLOCK(g_rw_lock_reader_trylock, GRWLock)
RG_UNLOCK(g_rw_lock_reader_unlock, GRWLock)

void g_cond_wait(GCond* condition, GMutex* mutex) {
  RG_REAL(g_cond_wait);
  __tsan_release(mutex);
  real(condition, mutex);
  __tsan_acquire(mutex);
}

gboolean g_cond_wait_until(GCond* condition, GMutex* mutex, gint64 end) {
  RG_REAL(g_cond_wait_until);
  __tsan_release(mutex);
  const gboolean isSignalled = real(condition, mutex, end);
  __tsan_acquire(mutex);
  return isSignalled;
}

// The last reference ends what all who held one before did.
void g_object_unref(gpointer object) {
  RG_REAL(g_object_unref);
  __tsan_release(object);
  __tsan_acquire(object);
  real(object);
}

void gst_mini_object_unref(GstMiniObject* object) {
  RG_REAL(gst_mini_object_unref);
  __tsan_release(object);
  __tsan_acquire(object);
  real(object);
}

}  // extern "C"
