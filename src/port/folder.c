/* SPDX-License-Identifier: MIT */
#include "port/folder.h"

#include <dirent.h>
#include <stddef.h>
#include <sys/stat.h>

GiFileKind gi_file_identify(const char *path, GiFileId *id) {
    struct stat info;
    if (stat(path, &info) != 0) return GI_FILE_MISSING;
    *id = (GiFileId){(uint64_t)info.st_dev, (uint64_t)info.st_ino};
    return S_ISDIR(info.st_mode)   ? GI_FILE_FOLDER
           : S_ISREG(info.st_mode) ? GI_FILE_REGULAR
                                   : GI_FILE_OTHER;
}

void gi_folder_visit(const char *path, bool (*visit)(void *user, const char *name), void *user) {
    DIR *folder = opendir(path);
    if (folder == NULL) return;
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        if (!visit(user, entry->d_name)) break;
    }
    closedir(folder);
}
