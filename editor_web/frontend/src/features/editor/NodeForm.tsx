/** The form of one node: what it runs and with what, where its outcomes lead, and what happens when it takes long or fails. */
import { Box, NativeSelect } from '@mantine/core'
import { IconCursorText, IconExternalLink, IconReplace } from '@tabler/icons-react'
import { KindIcon } from '../../components/KindIcon'
import { isForeign, isMachine, isTreePart, nodeOf, ROOT, type EditNode } from '../../document/editing/model'
import { setField } from '../../document/editing/edits'
import { enclosingReference } from '../../document/editing/referenceInlining'
import { kindLabel } from '../../document/tree'
import { nameOfPath, parentPath } from '../../document/path'
import { flowing } from '../../document/values'
import { Words } from '../../components/Words'
import { perform } from './apply'
import { openReferred } from './pageActions'
import { PolicyForm } from './PolicyForm'
import { PostForm } from './PostForm'
import { DataForm } from './DataForm'
import { DisabledForm } from './DisabledForm'
import { NodeFindings } from './FixButtons'
import { FlowSection } from './FlowSection'
import { FormHead, FormLine, FormWords, LinkButton } from './FormParts'
import { OrderForm } from './OrderForm'
import { OutcomeForm } from './OutcomeForm'
import { ParameterFields } from './ParameterFields'
import { RulesForm } from './RulesForm'
import { Section } from './Section'
import { SettingsForm } from './SettingsForm'
import { SourceLine } from './SourceLine'
import { TemplateInput } from './TemplateInput'
import { Tool } from './Tool'
import { openReplacePalette, replaceType } from './typeReplacement'
import { rootOf, setEditor, useEditor } from './store'

export interface NodeFormProps {
  readonly node: EditNode
  /** Nothing is selected: this is what fills the canvas. */
  readonly isScope: boolean
  /** So many more are chosen. */
  readonly others: number
}

export function NodeForm({ node, isScope, others }: NodeFormProps) {
  const root = useEditor(rootOf)
  const catalogue = useEditor((s) => s.catalogue)
  const parent = nodeOf(root, parentPath(node.path))
  if (root && isForeign(root, node.path)) return <Foreign node={node} root={root} />
  const state = catalogue?.states.find((each) => each.name === node.state)
  const behavior = catalogue?.behaviors.find((each) => each.id === node.document)
  const runs = node.kind === 'state' || node.kind === 'behavior'
  const keys = state?.parameters ?? behavior?.parameters ?? []
  const set = (field: string, value: unknown, words: string) =>
    void perform(`${words} of ${node.name}`, [setField(node.path, field, value)])
  return (
    <div data-form aria-label={`Form of ${node.name}`}>
      <FormHead
        icon={<KindIcon icon={node.icon} size={18} />}
        title={node.path === ROOT ? 'The whole behavior' : node.name}
        tools={
          <>
            <Tool
              isSmall
              label={`Replace ${node.name}`}
              title="Replace by another type (Shift+R)"
              onPress={() => openReplacePalette([node.path])}
            >
              <IconReplace size={15} aria-hidden />
            </Tool>
            {node.path !== ROOT && (
              <Tool
                isSmall
                label={`Rename ${node.name}`}
                title="Rename (F2)"
                onPress={() => setEditor({ renaming: node.path, selection: [node.path] })}
              >
                <IconCursorText size={15} aria-hidden />
              </Tool>
            )}
          </>
        }
      >
        {[kindLabel(node.kind), isScope && node.path !== ROOT ? 'fills the canvas' : '', others > 0 ? `and ${others} more selected` : '']
          .filter(Boolean)
          .join(', ')}
      </FormHead>
      <NodeFindings path={node.path} />
      {runs && (
        <Section title={node.kind === 'behavior' ? 'Behavior' : 'State'}>
          <TemplateInput
            label={node.kind === 'behavior' ? 'Refers to' : 'Runs'}
            isMono
            value={node.title}
            options={node.kind === 'state' ? (catalogue?.states.map((each) => each.name) ?? []) : []}
            onCommit={(typed) => typed && void replaceType([node.path], { kind: node.kind, runs: typed, name: '' })}
          />
          {state && (
            <FormWords>
              <Words text={flowing(state.doc)} />
            </FormWords>
          )}
          {state && <SourceLine state={state.name} />}
          {node.document && (
            <FormWords>
              {behavior?.description} <OpenOther id={node.document} from={node.path} />
            </FormWords>
          )}
        </Section>
      )}
      {runs && (
        <Section title="Parameters">
          <ParameterFields node={node} keys={keys} />
        </Section>
      )}
      {isMachine(parent?.kind ?? '') && parent && <OutcomeForm node={node} parent={parent} />}
      {node.kind === 'concurrency' && <RulesForm node={node} />}
      {isMachine(node.kind) && (
        <BeginForm node={node} onSet={(child) => void perform(`Start with ${child}`, [{ edit: 'set_initial', path: node.path, child }])} />
      )}
      {(isTreePart(node.kind) || node.kind === 'concurrency') && node.children.length > 1 && <OrderForm node={node} />}
      <SettingsForm node={node} />
      {runs && <DataForm node={node} inputs={state?.inputs ?? []} outputs={state?.outputs ?? []} />}
      <FlowSection node={node} />
      {node.path !== ROOT && <DisabledForm node={node} />}
      {node.path !== ROOT && node.kind !== 'guard' && <PolicyForm node={node} parent={parent} />}
      {parent && isTreePart(parent.kind) && <PostForm node={node} />}
      <Section title="Notes">
        <TemplateInput
          label="Description"
          isLong
          placeholder="Purpose, for readers of the behavior"
          value={node.description}
          onCommit={(typed) => set('description', typed || null, 'Description')}
        />
        <TemplateInput
          label="Notes"
          isLong
          placeholder="For those who edit it"
          value={node.notes}
          onCommit={(typed) => set('notes', typed || null, 'Notes')}
        />
      </Section>
    </div>
  )
}

function BeginForm({ node, onSet }: { node: EditNode; onSet: (child: string) => void }) {
  if (node.children.length === 0) return null
  return (
    <Section title="Machine">
      <FormLine label="Starts with">
        <NativeSelect
          size="xs"
          aria-label="Starts with"
          value={node.initial ?? ''}
          data={[
            ...(node.children.some((child) => child.name === node.initial)
              ? []
              : [{ value: node.initial ?? '', label: node.initial ?? 'choose' }]),
            ...node.children.map((child) => child.name),
          ]}
          onChange={(event) => onSet(event.currentTarget.value)}
        />
      </FormLine>
    </Section>
  )
}

function OpenOther({ id, from, node = '' }: { id: string; from: string; node?: string }) {
  return (
    <LinkButton onPress={() => openReferred(id, from, node)}>
      <IconExternalLink size={13} aria-hidden /> Open {nameOfPath(id)}
    </LinkButton>
  )
}

function Foreign({ node, root }: { node: EditNode; root: EditNode }) {
  const place = enclosingReference(root, node.path)
  return (
    <div data-form>
      <FormHead icon={<KindIcon icon={node.icon} size={18} />} title={node.name}>
        Part of a behavior that is referred to; it is changed in its own file.
      </FormHead>
      {place?.reference.document && (
        <Box p="sm">
          <OpenOther id={place.reference.document} from={place.reference.path} node={place.inner} />
        </Box>
      )}
    </div>
  )
}
