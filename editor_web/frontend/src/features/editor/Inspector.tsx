/** The form of what is chosen: the node, the behavior itself, and the problems of both. */
import { Tabs } from '@mantine/core'
import { problemsOf } from '../../document/editing/findings'
import { ArrowForm } from './ArrowForm'
import { DocumentForm } from './DocumentForm'
import { NodeForm } from './NodeForm'
import { ProblemList } from './ProblemList'
import { chosenOf, draftOf, scopeOf, setEditor, useEditor, type SideTab } from './store'

export function Inspector() {
  const tab = useEditor((s) => s.tab)
  const problems = useEditor((s) => problemsOf(draftOf(s)).length)
  const arrow = useEditor((s) => s.arrow)
  const several = useEditor((s) => s.selection.length)
  const chosen = useEditor(chosenOf)
  const scope = useEditor(scopeOf)
  const node = chosen ?? scope
  return (
    <Tabs
      value={tab}
      onChange={(value) => setEditor({ tab: (value ?? 'node') as SideTab })}
      className="side-tabs inspector"
      keepMounted={false}
    >
      <Tabs.List>
        <Tabs.Tab value="node">{arrow ? 'Arrow' : 'Node'}</Tabs.Tab>
        <Tabs.Tab value="document">Behavior</Tabs.Tab>
        <Tabs.Tab value="problems">
          Problems
          {problems > 0 && <span className="tab-count">{problems}</span>}
        </Tabs.Tab>
      </Tabs.List>
      <Tabs.Panel value="node">
        <div className="tab-body is-flush form-scroll">
          {arrow ? (
            <ArrowForm arrow={arrow} />
          ) : (
            node && <NodeForm key={node.path} node={node} isScope={!chosen} others={several - 1} />
          )}
        </div>
      </Tabs.Panel>
      <Tabs.Panel value="document">
        <div className="tab-body is-flush form-scroll">
          <DocumentForm />
        </div>
      </Tabs.Panel>
      <Tabs.Panel value="problems">
        <div className="tab-body form-scroll">
          <ProblemList />
        </div>
      </Tabs.Panel>
    </Tabs>
  )
}
