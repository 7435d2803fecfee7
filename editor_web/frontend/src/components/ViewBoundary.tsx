/** Keeps a view that fails from taking others with it: says what failed, tries again, hands out the details. */
import { Component, useState, type ErrorInfo, type ReactNode } from 'react'
import { forgetFailedLoads } from './lazyView'
import './viewBoundary.css'

interface ViewBoundaryProps {
  /** What it is called on the page, `Graph`. */
  readonly name: string
  /** What it shows; something else is tried although this has failed. */
  readonly of?: string
  readonly children: ReactNode
}

interface Failure {
  readonly error: unknown
  readonly stack: string
}

interface State {
  readonly failure: Failure | undefined
  readonly of: string
}

/** React tells of failures to classes only. */
export class ViewBoundary extends Component<ViewBoundaryProps, State> {
  override readonly state: State = { failure: undefined, of: '' }

  static getDerivedStateFromError(error: unknown): Partial<State> {
    return { failure: { error, stack: '' } }
  }

  static getDerivedStateFromProps({ of = '' }: ViewBoundaryProps, before: State): Partial<State> | null {
    return of === before.of ? null : { of, failure: undefined }
  }

  override componentDidCatch(error: unknown, { componentStack }: ErrorInfo): void {
    forgetFailedLoads()
    this.setState({ failure: { error, stack: componentStack ?? '' } })
  }

  override render(): ReactNode {
    const { failure } = this.state
    if (!failure) return this.props.children
    return <FailedView name={this.props.name} failure={failure} onAgain={() => this.setState({ failure: undefined })} />
  }
}

interface FailedViewProps {
  readonly name: string
  readonly failure: Failure
  readonly onAgain: () => void
}

function FailedView({ name, failure, onAgain }: FailedViewProps) {
  const [copied, setCopied] = useState<'no' | 'yes' | 'refused'>('no')
  const details = detailsOf(name, failure)

  function copy(): void {
    navigator.clipboard.writeText(details).then(
      () => setCopied('yes'),
      () => setCopied('refused'),
    )
  }

  return (
    <section className="failed-view" role="alert" aria-label={`Failure of ${name}`}>
      <strong>{name} cannot be shown</strong>
      <p>{messageOf(failure.error)}</p>
      <div className="command-row">
        <button type="button" className="command is-strong" onClick={onAgain}>
          Try again
        </button>
        <button type="button" className="command" onClick={copy}>
          {copied === 'yes' ? 'Copied' : 'Copy details'}
        </button>
      </div>
      <p className="quiet">The rest of the page still works. Please report the details.</p>
      {copied === 'refused' && <pre>{details}</pre>}
    </section>
  )
}

function messageOf(error: unknown): string {
  return error instanceof Error ? `${error.name}: ${error.message}` : String(error)
}

function detailsOf(name: string, { error, stack }: Failure): string {
  const trace = error instanceof Error ? (error.stack ?? '') : ''
  return [`${name} at ${location.pathname}`, messageOf(error), trace, stack, navigator.userAgent].filter(Boolean).join('\n')
}
