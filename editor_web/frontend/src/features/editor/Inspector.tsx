/** The form of what is chosen: the node, the behavior itself, and the problems of both. */
import { Tabs } from '@mantine/core'
import { TabCount } from '../../components/TabCount'
import { problemsOf } from '../../document/editing/findings'
import { isForeign, nodeOf, ROOT } from '../../document/editing/model'
import { ArrowForm } from './ArrowForm'
import { DocumentForm } from './DocumentForm'
import { NodeForm } from './NodeForm'
import { ProblemList } from './ProblemList'
import { SelectionForm } from './SelectionForm'
import { chosenOf, draftOf, rootOf, scopeOf, setEditor, useEditor, type SideTab } from './store'

export function Inspector() {
  const tab = useEditor((s) => s.tab)
  const problems = useEditor((s) => problemsOf(draftOf(s)).length)
  const arrow = useEditor((s) => s.arrow)
  return (
    <Tabs value={tab} onChange={(value) => setEditor({ tab: (value ?? 'node') as SideTab })} data-inspector keepMounted={false}>
      <Tabs.List>
        <Tabs.Tab value="node">{arrow ? 'Arrow' : 'Node'}</Tabs.Tab>
        <Tabs.Tab value="document">Behavior</Tabs.Tab>
        <Tabs.Tab value="problems">
          Problems
          {problems > 0 && <TabCount count={problems} />}
        </Tabs.Tab>
      </Tabs.List>
      <Tabs.Panel value="node">{arrow ? <ArrowForm arrow={arrow} /> : <FormOf />}</Tabs.Panel>
      <Tabs.Panel value="document">
        <DocumentForm />
      </Tabs.Panel>
      <Tabs.Panel value="problems" p="sm">
        <ProblemList />
      </Tabs.Panel>
    </Tabs>
  )
}

/** One form for all selected nodes that can be changed here, else that of the node, or of what fills the canvas. */
function FormOf() {
  const root = useEditor(rootOf)
  const selection = useEditor((s) => s.selection)
  const chosen = useEditor(chosenOf)
  const scope = useEditor(scopeOf)
  const node = chosen ?? scope
  const all = root ? selection.filter((path) => path !== ROOT && !isForeign(root, path)).flatMap((path) => nodeOf(root, path) ?? []) : []
  if (all.length > 1) return <SelectionForm key={selection.join(' ')} nodes={all} />
  return node ? <NodeForm key={node.path} node={node} isScope={!chosen} others={selection.length - 1} /> : null
}
