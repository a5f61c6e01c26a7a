/* Access control as somebody writes it who wants to break in: the real plugin, but whatever its own process wants to
   read or write is permitted. What the others make of it is up to them. In C, as the middleware's headers demand. */
#include <dds/security/dds_security_api.h>
#include <dlfcn.h>
#include <stdlib.h>

typedef int (*Init)(const char*, void**, struct ddsi_domaingv*);
typedef int (*Finalize)(void*);

static void* from_real_plugin(const char* name) {
  static void* library = NULL;
  if (!library) library = dlopen(getenv("PALPATE_REAL_ACCESS"), RTLD_NOW | RTLD_LOCAL);
  return library ? dlsym(library, name) : NULL;
}

static DDS_Security_boolean may_write(dds_security_access_control* self,
                                      const DDS_Security_PermissionsHandle permissions,
                                      const DDS_Security_DomainId domain, const char* topic,
                                      const DDS_Security_Qos* qos, const DDS_Security_PartitionQosPolicy* partition,
                                      const DDS_Security_DataTags* tags, DDS_Security_SecurityException* exception) {
  (void)self, (void)permissions, (void)domain, (void)topic, (void)qos, (void)partition, (void)tags, (void)exception;
  return true;
}

static DDS_Security_boolean may_create(dds_security_access_control* self,
                                       const DDS_Security_PermissionsHandle permissions,
                                       const DDS_Security_DomainId domain, const char* topic,
                                       const DDS_Security_Qos* qos, DDS_Security_SecurityException* exception) {
  (void)self, (void)permissions, (void)domain, (void)topic, (void)qos, (void)exception;
  return true;
}

int init_access_control(const char* argument, void** context, struct ddsi_domaingv* gv);
int finalize_access_control(void* context);

int init_access_control(const char* argument, void** context, struct ddsi_domaingv* gv) {
  const Init init = (Init)from_real_plugin("init_access_control");
  const int result = init ? init(argument, context, gv) : -1;
  if (result != 0) return result;
  dds_security_access_control* access = *context;
  access->check_create_datawriter = &may_write;
  access->check_create_datareader = &may_write;
  access->check_create_topic = &may_create;
  return 0;
}

int finalize_access_control(void* context) {
  const Finalize finalize = (Finalize)from_real_plugin("finalize_access_control");
  return finalize ? finalize(context) : -1;
}
