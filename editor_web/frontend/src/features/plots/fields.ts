/** The numbers that can be plotted: named, searched, and gathered in rows such as the joints of an arm. */
import type { SignalField, TopicFields } from '../../api/types'

export interface FieldRow {
  readonly name: string
  readonly unit: string
  readonly fields: readonly SignalField[]
}

/** How a number is asked for. */
export function idOf(topic: string, field: SignalField): string {
  return `${topic}:${field.path}`
}

/** Those that have all words of the search. */
export function shownTopics(topics: readonly TopicFields[], search: string): readonly TopicFields[] {
  const words = search.toLowerCase().split(/\s+/).filter(Boolean)
  if (words.length === 0) return topics
  return topics
    .map((topic) => {
      const fields = topic.fields.filter((field) => {
        const text = `${topic.topic} ${topic.type} ${field.label}`.toLowerCase()
        return words.every((word) => text.includes(word))
      })
      return { ...topic, fields }
    })
    .filter((topic) => topic.fields.length > 0)
}

/** The fields of a topic: those that differ only in their last word make a row. */
export function rowsOf(topic: TopicFields): readonly FieldRow[] {
  const rows = new Map<string, SignalField[]>()
  for (const field of topic.fields) {
    const cut = field.label.lastIndexOf(' ')
    const name = cut > 0 ? field.label.slice(0, cut) : field.label
    const row = rows.get(name)
    if (row) row.push(field)
    else rows.set(name, [field])
  }
  return [...rows].map(([name, fields]) => ({ name, fields, unit: fields[0]?.unit ?? '' }))
}

/** Label and unit of a chosen number, also of one whose topic is not there now. */
export function describe(
  id: string,
  topics: readonly TopicFields[],
): { readonly topic: string; readonly label: string; readonly unit: string } {
  const cut = id.lastIndexOf(':')
  const [topic, path] = [id.slice(0, cut), id.slice(cut + 1)]
  const field = topics.find((each) => each.topic === topic)?.fields.find((each) => each.path === path)
  return { topic, label: field?.label ?? path, unit: field?.unit ?? '' }
}

/** A colour for each chosen number: those that had one keep it, new ones take the first that is free. */
export function coloured(before: ReadonlyMap<string, number>, chosen: readonly string[]): ReadonlyMap<string, number> {
  const kept = new Map([...before].filter(([id]) => chosen.includes(id)))
  const taken = new Set(kept.values())
  for (const id of chosen) {
    if (kept.has(id)) continue
    let color = 0
    while (taken.has(color)) color += 1
    kept.set(id, color)
    taken.add(color)
  }
  return kept
}
