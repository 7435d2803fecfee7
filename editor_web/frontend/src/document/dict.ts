/** Dictionaries whose keys are names that people choose: `constructor` and `__proto__` are names like all others. Pure. */

/** Every key that is written in our own sources. A `string` is none of them. */
// oxlint-disable-next-line typescript/no-explicit-any -- of `${string}` every string would be one
type Literal = `${any}`

/**
 * A dictionary by name, as JSON brings it. `dict[name]` would also find what every object inherits, and does not
 * compile; `lookup` looks at its own keys only. New ones are made by literals, spreads with `[name]: value` and
 * `Object.fromEntries`, which define keys; an assignment would set the prototype.
 */
export type Dict<T> = { readonly [K in Literal]: T }

/** What is named so; undefined where nothing is. */
export function lookup<T>(dict: Dict<T> | undefined, name: string | number): T | undefined {
  return dict !== undefined && Object.hasOwn(dict, name) ? (dict as Readonly<Record<string, T>>)[name] : undefined
}

/** The same without one name. */
export function without<T>(dict: Dict<T>, name: string): Dict<T> {
  return Object.fromEntries(Object.entries(dict).filter(([each]) => each !== name))
}

/** The fields of a value that has some; none of a list or a plain value. */
export function fieldsOf(value: unknown): Dict<unknown> {
  return typeof value === 'object' && value !== null && !Array.isArray(value) ? (value as Dict<unknown>) : {}
}
