/*
 * Every message about the input: number, severity, title, and what to do.
 * The numbers never change their meaning; see message.h for the ranges.
 */
#ifndef PROTIS_BASE_MESSAGES_H
#define PROTIS_BASE_MESSAGES_H

/* clang-format off */
#define MESSAGE_LIST(X)                                                      \
  X(1001, ERROR, "file of the deck cannot be read",                          \
    "Check the name and the permissions; *INCLUDE is relative to the file "  \
    "it stands in.")                                                         \
  X(1003, ERROR, "unknown card",                                             \
    "protis --keywords lists the cards. Names match in full, never by "      \
    "their beginning.")                                                      \
  MESSAGE_LIST_MODEL(X)                                                      \
  MESSAGE_LIST_MESH(X)

#define MESSAGE_LIST_MODEL(X)                                                \
  X(2001, ERROR, "card not available in this version",                       \
    "The card is reserved; a later version will read it.")

#define MESSAGE_LIST_MESH(X)                                                 \
  X(3001, ERROR, "mesh file cannot be read",                                 \
    "Check the name and that gmsh opens the file.")
/* clang-format on */

#endif
