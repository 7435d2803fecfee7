/** What userdata is assigned when a part of a tree has ended, or was halted. */
import { lookup } from '../../document/dict'
import { setField } from '../../document/editing/edits'
import { assignedText, assignments } from '../../document/editing/assignmentText'
import type { EditNode } from '../../document/editing/model'
import { performOn } from './apply'
import { FormLine } from './FormParts'
import { Section } from './Section'
import { TemplateInput } from './TemplateInput'

const SECTIONS = [
  { key: 'on_success', words: 'After success' },
  { key: 'on_failure', words: 'After failure' },
  { key: 'on_halted', words: 'When halted' },
  { key: 'always', words: 'After either' },
] as const

export function PostForm({ node }: { node: EditNode }) {
  const set = (section: string, typed: string) =>
    void performOn(node.path, `post of ${node.name}`, (now) => {
      const made = assignments(typed)
      const kept = Object.entries({ ...now.post, [section]: made }).filter(([, each]) => Object.keys(each ?? {}).length > 0)
      return [setField(node.path, 'post', kept.length > 0 ? Object.fromEntries(kept) : null)]
    })
  return (
    <Section title="Assign afterwards" isClosed={node.post === null} note={node.post === null ? undefined : 'set'}>
      {SECTIONS.map(({ key, words }) => (
        <FormLine key={key} label={words}>
          <TemplateInput
            label={words}
            isLong
            isMono
            placeholder="key: value, one a line"
            value={assignedText(node.post === null ? undefined : lookup(node.post, key))}
            onCommit={(typed) => set(key, typed)}
          />
        </FormLine>
      ))}
    </Section>
  )
}
